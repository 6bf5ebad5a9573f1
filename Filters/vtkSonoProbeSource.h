#ifndef vtkSonoProbeSource_h
#define vtkSonoProbeSource_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

namespace sono {
struct ProbeField;
}

/**
 * @class vtkSonoProbeSource
 * @brief An ultrasound probe: its scan lines, where it stands, and its pulse
 *
 * The output shows the outline of the scanned area (cell 0) and the transducer's face (cell 1), or the far border and
 * the four edges of a matrix's volume, in world coordinates, LPS mm. Its field data hold everything that later stages
 * need of the probe.
 */
class VTKSONOFILTERS_EXPORT vtkSonoProbeSource : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoProbeSource* New();
  vtkTypeMacro(vtkSonoProbeSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * A preset that gives layout and pulse: the name of a bundled one, see vtkSonoProbePresets, or a JSON file; where it
   * is empty, the numbers below do. Default empty.
   */
  vtkSetStdStringFromCharMacro(PresetFile);
  vtkGetCharFromStdStringMacro(PresetFile);
  ///@}

  enum ScanKinds
  {
    LINEAR = 0,
    PHASED_SECTOR = 1,
    CURVILINEAR = 2,
    MATRIX = 3,
    RADIAL = 4
  };

  ///@{
  /**
   * Layout of the scan lines. Default PHASED_SECTOR.
   */
  vtkSetMacro(ScanKind, int);
  vtkGetMacro(ScanKind, int);
  ///@}

  ///@{
  /**
   * Number of scan lines, 1 to 4096; of a matrix, in each elevation. Default 128.
   */
  vtkSetMacro(LineCount, int);
  vtkGetMacro(LineCount, int);
  ///@}

  ///@{
  /**
   * Depth along each line from the face in mm, above 0. Default 160.
   */
  vtkSetMacro(DepthMm, double);
  vtkGetMacro(DepthMm, double);
  ///@}

  ///@{
  /**
   * Angle between the outermost lines in degrees, between 0 and 180, or up to 360 for radial probes; not for linear
   * ones. Default 90.
   */
  vtkSetMacro(SectorDeg, double);
  vtkGetMacro(SectorDeg, double);
  ///@}

  ///@{
  /**
   * Radius of a curvilinear or radial probe's face in mm, above 0. Default 60.
   */
  vtkSetMacro(RadiusMm, double);
  vtkGetMacro(RadiusMm, double);
  ///@}

  ///@{
  /**
   * Distance of a linear probe's outermost lines in mm, above 0. Default 38.
   */
  vtkSetMacro(WidthMm, double);
  vtkGetMacro(WidthMm, double);
  ///@}

  ///@{
  /**
   * Elevations of a matrix probe, 1 to 4096, at most 65536 lines altogether. Default 32.
   */
  vtkSetMacro(ElevationLineCount, int);
  vtkGetMacro(ElevationLineCount, int);
  ///@}

  ///@{
  /**
   * Angle between the outermost elevations of a matrix probe in degrees, between 0 and 180. Default 60.
   */
  vtkSetMacro(ElevationSectorDeg, double);
  vtkGetMacro(ElevationSectorDeg, double);
  ///@}

  ///@{
  /**
   * Centre of the transducer's face in world coordinates, LPS mm. Default (87.8, -86.5, -45): with the
   * two directions' defaults, the apical four-chamber view of the bundled thorax.
   */
  vtkSetVector3Macro(PositionMm, double);
  vtkGetVector3Macro(PositionMm, double);
  ///@}

  ///@{
  /**
   * Direction into the body, of any length above 0. Default (-0.53, 0.65, 0.545).
   */
  vtkSetVector3Macro(Axial, double);
  vtkGetVector3Macro(Axial, double);
  ///@}

  ///@{
  /**
   * Direction along the array, not parallel to Axial; made orthogonal to it. Default (0.843, 0.333, 0.423).
   */
  vtkSetVector3Macro(Lateral, double);
  vtkGetVector3Macro(Lateral, double);
  ///@}

  ///@{
  /**
   * Centre frequency of the pulse in MHz, above 0. Default 2.5.
   */
  vtkSetMacro(CentreFrequencyMHz, double);
  vtkGetMacro(CentreFrequencyMHz, double);
  ///@}

  ///@{
  /**
   * Bandwidth of the pulse at -6 dB as a part of the centre frequency, between 0 and 2. Default 0.6.
   */
  vtkSetMacro(FractionalBandwidth, double);
  vtkGetMacro(FractionalBandwidth, double);
  ///@}

  ///@{
  /**
   * Whether the probe is being moved. The stages then make a coarse image quickly: at most 60 paths a line, RF sampled
   * at four times the centre frequency at most, scatterer cells up to twice and pixels twice as wide as they are set
   * to. Default off.
   */
  vtkSetMacro(Preview, bool);
  vtkGetMacro(Preview, bool);
  vtkBooleanMacro(Preview, bool);
  ///@}

protected:
  vtkSonoProbeSource();
  ~vtkSonoProbeSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoProbeSource(const vtkSonoProbeSource&) = delete;
  void operator=(const vtkSonoProbeSource&) = delete;

  sono::ProbeField Probe() const;

  std::string PresetFile;
  int ScanKind = PHASED_SECTOR;
  int LineCount = 128;
  double DepthMm = 160.0;
  double SectorDeg = 90.0;
  double RadiusMm = 60.0;
  double WidthMm = 38.0;
  int ElevationLineCount = 32;
  double ElevationSectorDeg = 60.0;
  double PositionMm[3] = { 87.8, -86.5, -45.0 };
  double Axial[3] = { -0.53, 0.65, 0.545 };
  double Lateral[3] = { 0.843, 0.333, 0.423 };
  double CentreFrequencyMHz = 2.5;
  double FractionalBandwidth = 0.6;
  bool Preview = false;
};

#endif
