#ifndef vtkSonoImageFormation_h
#define vtkSonoImageFormation_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
class Simulator;
struct EchoSettings;
struct ProbeField;
struct SampledPulse;
}

/**
 * @class vtkSonoImageFormation
 * @brief Turns traced scan lines into radio-frequency lines
 *
 * Takes output 0 of vtkSonoRayTracer, which carries scene and probe (port 0), and, optionally, scatterers of the user's
 * own besides those of the tissues (port 1): points in world coordinates, LPS mm, with the point array "Amplitude", the
 * echo of each on the axis of a beam where the intensity is 1. An optional pulse-echo field (port 2, the output of
 * vtkSonoPulseEchoField) takes the place of the Gaussian beam; it must reach the probe's depth. The output holds lines
 * x RF samples, x the range in mm and y the number of the scan line, with the point arrays "RF", "IQ" (complex,
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

  enum Beams
  {
    GAUSSIAN_BEAM = 0,
    COMPUTED_BEAM = 1
  };

  ///@{
  /**
   * Units, ranges, defaults and what they do: sono::EchoSettings.
   */
  sonoParameter(Device, int);
  sonoParameter(Beam, int);
  sonoParameter(LateralSigmaMm, double);
  sonoParameter(ElevationalSigmaMm, double);
  sonoParameter(ScattererCellMm, double);
  sonoParameter(ScattererLevelDb, double);
  sonoParameter(ScattererSeed, int);
  ///@}

  ///@{
  /**
   * A pulse (CSV with the columns time_us and amplitude, time 0 at the scatterer) in place of the Gaussian one of the
   * probe's bandwidth. Default empty: the Gaussian.
   */
  vtkSetStdStringFromCharMacro(PulseFileName);
  vtkGetCharFromStdStringMacro(PulseFileName);
  ///@}

  /**
   * What the stage is asked to do: the parameters with what comes from the probe and, in MHz, the tracer, but neither
   * pulse nor pulse-echo field. Throws sono::Error for what is out of range.
   */
  sono::EchoSettings Settings(const sono::ProbeField& probe, double samplingMHz) const;

  /**
   * The pulse of the file that is named, or null. Throws sono::Error when it cannot be read.
   */
  std::shared_ptr<const sono::SampledPulse> ReadPulse() const;

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

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::unique_ptr<sono::Simulator> Simulator;
  std::string PulseFileName;
};

#endif
