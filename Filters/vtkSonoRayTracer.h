#ifndef vtkSonoRayTracer_h
#define vtkSonoRayTracer_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

namespace sono {
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
 * "Intensity" (mean one-way intensity, 1 at the transducer) and "StandardError" (of that mean). Its field data carry
 * the scene, the probe and the boundary echoes, so that it alone suffices for vtkSonoImageFormation.
 * Output 1: lines x RF samples with the complex point array "BoundaryEcho".
 * Output 2: some of the paths as polylines in the world, for display, with the point arrays "Intensity" (on arrival),
 * "IntensityDb" (20 log10 of it) and "Bounce" (boundaries met before), and the cell array "Line".
 * Output 3: the boundaries that these paths met, as vertices on the surfaces, with the same arrays and "Normals" (into
 * the tissue behind), "IncidenceDeg" (between path and normal), "EchoAmplitude" (of the boundary's echo, before the
 * coherence weight), "DepthMm" (along the scan line, where the echo appears), "PathMm" (travelled since the
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

  ///@{
  /**
   * Where to compute: on the GPU where there is one, else on the CPU, which is said once; or on either alone. The
   * results differ by rounding. Default AUTO.
   */
  vtkSetMacro(Device, int);
  vtkGetMacro(Device, int);
  ///@}

  enum InterfaceModels
  {
    ACOUSTIC = 0,
    AMADOU_2024 = 1
  };

  ///@{
  /**
   * What happens at a boundary: fluid acoustics, which conserves energy, or the equations of Amadou et al. 2024 to
   * the letter, which do not. Default ACOUSTIC.
   */
  vtkSetMacro(InterfaceModel, int);
  vtkGetMacro(InterfaceModel, int);
  ///@}

  enum Samplings
  {
    INDEPENDENT = 0,
    LOW_DISCREPANCY = 1,
    SHARED_PATHS = 2
  };

  ///@{
  /**
   * Where a path's random numbers come from: independent ones, or scrambled Sobol points with less noise. With
   * SHARED_PATHS eight neighbouring lines share their paths, too: each takes two to four times as long, but a tenth of
   * them gives the same noise. Default LOW_DISCREPANCY.
   */
  vtkSetMacro(Sampling, int);
  vtkGetMacro(Sampling, int);
  ///@}

  ///@{
  /**
   * Paths per scan line, 1 to 10^7; the noise falls with their square root. Default 1000.
   */
  vtkSetMacro(PathsPerLine, int);
  vtkGetMacro(PathsPerLine, int);
  ///@}

  ///@{
  /**
   * Boundaries that a path may meet, 0 to 1000. Default 7.
   */
  vtkSetMacro(MaxCollisions, int);
  vtkGetMacro(MaxCollisions, int);
  ///@}

  ///@{
  /**
   * C0 in mm, at least 0: a path at this distance from the main beam counts half. Default 100.
   */
  vtkSetMacro(CoherenceMm, double);
  vtkGetMacro(CoherenceMm, double);
  ///@}

  ///@{
  /**
   * Follow only the refracted direction, without chance and without spreading. Default off.
   */
  vtkSetMacro(Deterministic, bool);
  vtkGetMacro(Deterministic, bool);
  vtkBooleanMacro(Deterministic, bool);
  ///@}

  ///@{
  /**
   * Mean angle between an outgoing direction and the mirrored or refracted one, in degrees. Default 0.
   */
  vtkSetMacro(LobeMeanDeg, double);
  vtkGetMacro(LobeMeanDeg, double);
  ///@}

  ///@{
  /**
   * Standard deviation of that angle in degrees, at least 0; 0 is a mirror. Default 45.
   */
  vtkSetMacro(LobeSigmaDeg, double);
  vtkGetMacro(LobeSigmaDeg, double);
  ///@}

  ///@{
  /**
   * Least such angle in degrees. Default 0.
   */
  vtkSetMacro(LobeMinDeg, double);
  vtkGetMacro(LobeMinDeg, double);
  ///@}

  ///@{
  /**
   * Largest such angle in degrees, above the least, up to 90. Default 90.
   */
  vtkSetMacro(LobeMaxDeg, double);
  vtkGetMacro(LobeMaxDeg, double);
  ///@}

  ///@{
  /**
   * Width of an intensity sample along a scan line in mm, above 0. Default 0.25.
   */
  vtkSetMacro(RadialBinMm, double);
  vtkGetMacro(RadialBinMm, double);
  ///@}

  ///@{
  /**
   * Sampling frequency of the RF lines in MHz, more than twice the centre frequency; also that of the boundary
   * echoes. Default 50.
   */
  vtkSetMacro(SamplingMHz, double);
  vtkGetMacro(SamplingMHz, double);
  ///@}

  ///@{
  /**
   * Paths fainter than this, 20 log10 of the intensity, -1000 to 0, are ended by chance and the others of their kind
   * count more. Default -100.
   */
  vtkSetMacro(RouletteDb, double);
  vtkGetMacro(RouletteDb, double);
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

  ///@{
  /**
   * Seed of the paths, at least 0: the same seed gives the same result. Default 1.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

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

  sono::TraceSettings Settings(const sono::ProbeField& probe) const;

  int InterfaceModel = ACOUSTIC;
  int Sampling = LOW_DISCREPANCY;
  int PathsPerLine = 1000;
  int MaxCollisions = 7;
  double CoherenceMm = 100.0;
  bool Deterministic = false;
  double LobeMeanDeg = 0.0;
  double LobeSigmaDeg = 45.0;
  double LobeMinDeg = 0.0;
  double LobeMaxDeg = 90.0;
  double RadialBinMm = 0.25;
  double SamplingMHz = 50.0;
  double RouletteDb = -100.0;
  std::string TargetTissue = "cortical_bone";
  int NumberOfShownPaths = 0;
  int Device = AUTO;
  int Seed = 1;
};

#endif
