#ifndef vtkSonoChannelData_h
#define vtkSonoChannelData_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
struct ChannelPoints;
struct ProbeField;
}

class vtkPointSet;

/**
 * @class vtkSonoChannelData
 * @brief What each element of the array receives, of plane, diverging or focused waves
 *
 * Takes output 0 of vtkSonoRayTracer, which carries scene and probe (port 0): the same scatterers and surfaces as the
 * picture's echo, weighted by the traced intensity. Or a vtkSonoProbeSource: then nothing but the scatterers of port 1
 * echo, points in world coordinates, LPS mm, with the point array "Amplitude"; in a scene that is the echo on the axis
 * of a beam, as in vtkSonoImageFormation, without one the root of a cross-section in mm.
 *
 * The output holds samples x elements x transmits, x the time in us, with the point array "RF". Its field data have,
 * for beamforming, "ElementPositionsMm" and "ElementAzimuthsRad", of each transmit "TransmitDelaysUs" and
 * "TransmitWeights" (a component an element) and "TransmitAnglesRad", and the numbers "TransmitDistanceMm",
 * "TransmitKindNumber", "ChannelSamplingMHz" and "PassUs", when each wave passes the middle of the face. Data/docs/
 * physics.md section 15.
 */
class VTKSONOFILTERS_EXPORT vtkSonoChannelData : public vtkImageAlgorithm
{
public:
  static vtkSonoChannelData* New();
  vtkTypeMacro(vtkSonoChannelData, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Devices
  {
    AUTO = 0,
    CPU = 1,
    CUDA = 2
  };

  enum TransmitKinds
  {
    PLANE_WAVES = 0,
    DIVERGING_WAVES = 1,
    FOCUSED_WAVES = 2
  };

  ///@{
  /**
   * Units, ranges, defaults and what they do: sono::ChannelSettings.
   */
  sonoParameter(TransmitKind, int);
  sonoParameter(TransmitCount, int);
  sonoParameter(TransmitSpanDeg, double);
  sonoParameter(TransmitDistanceMm, double);
  sonoParameter(Apodization, int);
  sonoParameter(ElementCount, int);
  sonoParameter(ChannelSamplingMHz, double);
  sonoParameter(Baffle, int);
  sonoSwitch(Flat);
  sonoParameter(AttenuationDbPerCmMHz, double);
  sonoParameter(ScatterersPerCell, int);
  sonoParameter(ScattererSeed, int);
  sonoParameter(Device, int);
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
  vtkSonoChannelData();
  ~vtkSonoChannelData() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoChannelData(const vtkSonoChannelData&) = delete;
  void operator=(const vtkSonoChannelData&) = delete;

  /// What echoes: of traced lines, or of points alone.
  sono::ChannelPoints Points(vtkDataObject* input, const sono::ProbeField& probe, vtkPointSet* scatterers);

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::string PulseFileName;
};

#endif
