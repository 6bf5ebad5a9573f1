#ifndef vtkSonoImageFormation_h
#define vtkSonoImageFormation_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

namespace sono {
struct EchoSettings;
}
class vtkFieldData;

/**
 * @class vtkSonoImageFormation
 * @brief Turns traced scan lines into radio-frequency lines
 *
 * Takes output 0 of vtkSonoRayTracer, which carries scene and probe (port 0), and, optionally, scatterers of the user's
 * own besides those of the tissues (port 1): points in world coordinates, LPS mm, with the point array "Amplitude", the
 * echo of each on the axis of a beam where the intensity is 1. An optional pulse-echo field (port 2, the output of
 * vtkSonoPulseEchoField) takes the place of the Gaussian beam; it must reach the probe's depth. The output holds lines
 * x RF samples, x the depth in mm and y the number of the scan line, with the point arrays "RF", "IQ" (complex,
 * demodulated) and "Envelope" (the modulus of IQ).
 */
class VTKSONOFILTERS_EXPORT vtkSonoImageFormation : public vtkImageAlgorithm
{
public:
  static vtkSonoImageFormation* New();
  vtkTypeMacro(vtkSonoImageFormation, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Devices
  {
    AUTO = 0,
    CPU = 1,
    CUDA = 2
  };

  ///@{
  /**
   * Where to compute: on the GPU where there is one, else on the CPU, which is said once; or on either alone. The
   * results differ by rounding. Default AUTO.
   */
  vtkSetMacro(Device, int);
  vtkGetMacro(Device, int);
  ///@}

  ///@{
  /**
   * Standard deviation of the Gaussian beam along the array in mm, above 0. Default 1.
   */
  vtkSetMacro(LateralSigmaMm, double);
  vtkGetMacro(LateralSigmaMm, double);
  ///@}

  ///@{
  /**
   * Standard deviation of the Gaussian beam across the image plane in mm, above 0. Default 1.
   */
  vtkSetMacro(ElevationalSigmaMm, double);
  vtkGetMacro(ElevationalSigmaMm, double);
  ///@}

  ///@{
  /**
   * Edge h of the cells that hold one scatterer each in mm, above 0; their density is mu1 / h^3. Default 0.5.
   */
  vtkSetMacro(ScattererCellMm, double);
  vtkGetMacro(ScattererCellMm, double);
  ///@}

  ///@{
  /**
   * RMS echo of a tissue full of scatterers against a perfect plane reflector in dB, -200 to 200. Default -30.
   */
  vtkSetMacro(ScattererLevelDb, double);
  vtkGetMacro(ScattererLevelDb, double);
  ///@}

  ///@{
  /**
   * Seed of the scatterers, at least 0. Default 1.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * A pulse (CSV with the columns time_us and amplitude, time 0 at the scatterer) in place of the Gaussian one of the
   * probe's bandwidth. Default empty: the Gaussian.
   */
  vtkSetStdStringFromCharMacro(PulseFileName);
  vtkGetCharFromStdStringMacro(PulseFileName);
  ///@}

protected:
  vtkSonoImageFormation();
  ~vtkSonoImageFormation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoImageFormation(const vtkSonoImageFormation&) = delete;
  void operator=(const vtkSonoImageFormation&) = delete;

  sono::EchoSettings Settings(vtkFieldData* acquisition) const;

  double LateralSigmaMm = 1.0;
  double ElevationalSigmaMm = 1.0;
  double ScattererCellMm = 0.5;
  double ScattererLevelDb = -30.0;
  int Device = AUTO;
  int Seed = 1;
  std::string PulseFileName;
};

#endif
