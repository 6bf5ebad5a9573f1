#ifndef vtkSonoRayTracer_h
#define vtkSonoRayTracer_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
class Simulator;
struct ProbeField;
struct TraceSettings;
}

/**
 * @class vtkSonoRayTracer
 * @brief Traces the scan lines of a probe through the anatomy
 *
 * Inputs: the scene of vtkSonoSceneBuilder (port 0), the probe of vtkSonoProbeSource (port 1) and, optionally, targets
 * (port 2): closed polygon surfaces in world coordinates, LPS mm, such as needles and test objects, inside which the
 * label map does not count. Their tissue is named, in this order, by a cell array of strings "Tissue", a field array of
 * one string "Tissue", or TargetTissue.
 * Output 0: lines x radial bins, x the depth in mm and y the number of the scan line, with the point arrays
 * "Intensity" (mean one-way intensity, 1 at the transducer), "StandardError" (of that mean) and
 * "AttenuationNpPerMHz" (two-way exponent of the amplitude per MHz). In the model Acoustic they reach 4 % deeper than
 * the image, since range is time there. Its field data carry "TracedPaths" (of a line), with a target error or a time
 * budget "ErrorDb" (of the picture, as far as it was reached), the scene, the probe, the boundary echoes and
 * "DepthOffsetMm" (by line and range: how much deeper than the range of each bin's start lies what is shown there; of
 * Acoustic), so that it alone suffices for vtkSonoImageFormation.
 * Output 1: lines x RF samples with the complex point array "BoundaryEcho", of Amadou 2024; empty for Acoustic.
 * Output 2: some of the paths as polylines in the world, for display, with the point arrays "Intensity" (on arrival),
 * "IntensityDb" (20 log10 of it) and "Bounce" (boundaries met before), and the cell array "Line".
 * Output 3: the boundaries that these paths met, as vertices on the surfaces, with the same arrays and "Normals" (into
 * the tissue behind), "IncidenceDeg" (between path and normal), "EchoAmplitude" (of the boundary's echo, before the
 * coherence weight), "DepthMm" (along the scan line), "PathMm" (travelled since the
 * transducer), and the names "FromTissue" and "ToTissue"; "Line" is a point array there.
 */
class VTKSONOFILTERS_EXPORT vtkSonoRayTracer : public vtkImageAlgorithm
{
public:
  static vtkSonoRayTracer* New();
  vtkTypeMacro(vtkSonoRayTracer, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Devices
  {
    AUTO = 0,
    CPU = 1,
    CUDA = 2
  };
  enum InterfaceModels
  {
    ACOUSTIC = 0,
    AMADOU_2024 = 1
  };
  enum Samplings
  {
    INDEPENDENT = 0,
    LOW_DISCREPANCY = 1
  };

  ///@{
  /**
   * Units, ranges, defaults and what they do: sono::TraceSettings.
   */
  sonoParameter(Device, int);
  sonoParameter(InterfaceModel, int);
  sonoParameter(Sampling, int);
  sonoParameter(PathsPerLine, int);
  sonoParameter(TargetErrorDb, double);
  sonoParameter(TimeBudgetS, double);
  sonoParameter(MaxCollisions, int);
  sonoSwitch(Reverberation);
  sonoParameter(FaceReflection, double);
  sonoParameter(CoherenceMm, double);
  sonoSwitch(Deterministic);
  sonoParameter(LobeMeanDeg, double);
  sonoParameter(LobeSigmaDeg, double);
  sonoParameter(LobeMinDeg, double);
  sonoParameter(LobeMaxDeg, double);
  sonoParameter(RadialBinMm, double);
  sonoParameter(RouletteDb, double);
  sonoParameter(PathSeed, int);
  ///@}

  ///@{
  /**
   * Sampling frequency of the RF lines in MHz, more than twice the centre frequency; also that of the boundary
   * echoes; 0 (the default): eight times the centre frequency.
   */
  vtkSetMacro(SamplingMHz, double);
  vtkGetMacro(SamplingMHz, double);
  ///@}

  ///@{
  /**
   * Tissue of the targets where they name none of their own; one of the scene's tissue table. Default cortical_bone.
   */
  vtkSetStdStringFromCharMacro(TargetTissue);
  vtkGetCharFromStdStringMacro(TargetTissue);
  ///@}

  ///@{
  /**
   * Paths on output 2, whose boundaries are on output 3, 0 to 100,000, chosen evenly from all. Default 0.
   */
  vtkSetMacro(NumberOfShownPaths, int);
  vtkGetMacro(NumberOfShownPaths, int);
  ///@}

  /**
   * What the tracer is asked to do for a probe: the parameters with what comes from the probe. Throws sono::Error for
   * what is out of range.
   */
  sono::TraceSettings Settings(const sono::ProbeField& probe) const;

  /**
   * Sampling frequency of this probe's RF lines: lower than it is set while the probe is being moved.
   */
  double RfSamplingMHz(const sono::ProbeField& probe) const;

protected:
  vtkSonoRayTracer();
  ~vtkSonoRayTracer() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoRayTracer(const vtkSonoRayTracer&) = delete;
  void operator=(const vtkSonoRayTracer&) = delete;

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::unique_ptr<sono::Simulator> Simulator;
  double SamplingMHz = 0.0;
  std::string TargetTissue = "cortical_bone";
  int NumberOfShownPaths = 0;
};

#endif
