#ifndef vtkSonoPulseEchoField_h
#define vtkSonoPulseEchoField_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
class PulseEchoField;
struct ArrayAperture;
struct FieldGrid;
}

/**
 * @class vtkSonoPulseEchoField
 * @brief The two-way beam of an array, computed or read, for vtkSonoImageFormation
 *
 * The output is an image in the frame of a scan line (x lateral, y elevational, z depth, mm) with the point array
 * "PulseEchoWeight": the amplitude of an echo from there, relative to the largest one. A lateral or elevational axis
 * that starts at 0 holds half of a symmetric beam. The defaults are the bundled preset of a P4-2 class phased array. A
 * computed field is kept until a number that it depends on changes.
 */
class VTKSONOFILTERS_EXPORT vtkSonoPulseEchoField : public vtkImageAlgorithm
{
public:
  static vtkSonoPulseEchoField* New();
  vtkTypeMacro(vtkSonoPulseEchoField, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * A file (NRRD with the axes lateral, elevational and depth in mm) to read the field from; where it is empty, it is
   * computed from the numbers below. Default empty.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * Active elements, side by side along the array, 1 to 4096. Default 64.
   */
  vtkSetMacro(ElementCount, int);
  vtkGetMacro(ElementCount, int);
  ///@}

  ///@{
  /**
   * Width of an element along the array in mm, above 0. Default 0.295.
   */
  vtkSetMacro(ElementWidthMm, double);
  vtkGetMacro(ElementWidthMm, double);
  ///@}

  ///@{
  /**
   * Height of an element across the image plane in mm, above 0. Default 14.
   */
  vtkSetMacro(ElementHeightMm, double);
  vtkGetMacro(ElementHeightMm, double);
  ///@}

  ///@{
  /**
   * Gap between two elements in mm, at least 0. Default 0.025.
   */
  vtkSetMacro(KerfMm, double);
  vtkGetMacro(KerfMm, double);
  ///@}

  ///@{
  /**
   * Radius of a convex face in mm; 0 is flat. Default 0.
   */
  vtkSetMacro(FaceRadiusMm, double);
  vtkGetMacro(FaceRadiusMm, double);
  ///@}

  ///@{
  /**
   * Depth of the transmit focus in mm; 0 is no focus. Reception focuses at every depth. Default 65.
   */
  vtkSetMacro(TransmitFocusMm, double);
  vtkGetMacro(TransmitFocusMm, double);
  ///@}

  ///@{
  /**
   * Depth of the lens's focus across the image plane in mm; 0 is no lens. Default 60.
   */
  vtkSetMacro(ElevationFocusMm, double);
  vtkGetMacro(ElevationFocusMm, double);
  ///@}

  enum Apodizations
  {
    BOXCAR = 0,
    HANN = 1
  };

  ///@{
  /**
   * Weights of the elements, in transmit and receive. Default BOXCAR.
   */
  vtkSetMacro(Apodization, int);
  vtkGetMacro(Apodization, int);
  ///@}

  ///@{
  /**
   * Centre frequency in MHz, above 0. Default 3.6.
   */
  vtkSetMacro(CentreFrequencyMHz, double);
  vtkGetMacro(CentreFrequencyMHz, double);
  ///@}

  ///@{
  /**
   * Bandwidth of the echo at -6 dB as a part of the centre frequency, 0 (one frequency) to below 2. Default 0.74.
   */
  vtkSetMacro(FractionalBandwidth, double);
  vtkGetMacro(FractionalBandwidth, double);
  ///@}

  ///@{
  /**
   * One-way attenuation in dB/(cm MHz), at least 0; 0 where a traced image carries it already. Default 0.
   */
  vtkSetMacro(AttenuationDbPerCmMHz, double);
  vtkGetMacro(AttenuationDbPerCmMHz, double);
  ///@}

  ///@{
  /**
   * Depth that the field reaches in mm, above 0; at least the probe's. Default 160.
   */
  vtkSetMacro(DepthMm, double);
  vtkGetMacro(DepthMm, double);
  ///@}

protected:
  vtkSonoPulseEchoField();
  ~vtkSonoPulseEchoField() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoPulseEchoField(const vtkSonoPulseEchoField&) = delete;
  void operator=(const vtkSonoPulseEchoField&) = delete;

  sono::ArrayAperture Aperture() const;
  void Compute(const sono::ArrayAperture& aperture, const sono::FieldGrid& grid);

  std::string FileName;
  int ElementCount = 64;
  double ElementWidthMm = 0.295;
  double ElementHeightMm = 14.0;
  double KerfMm = 0.025;
  double FaceRadiusMm = 0.0;
  double TransmitFocusMm = 65.0;
  double ElevationFocusMm = 60.0;
  int Apodization = BOXCAR;
  double CentreFrequencyMHz = 3.6;
  double FractionalBandwidth = 0.74;
  double AttenuationDbPerCmMHz = 0.0;
  double DepthMm = 160.0;

  std::shared_ptr<const sono::PulseEchoField> Field;      // the last one that was read or computed
  std::shared_ptr<const sono::ArrayAperture> FieldsArray; // what it was computed from; null when it was read
};

#endif
