#ifndef vtkSonoProbeSource_h
#define vtkSonoProbeSource_h

#include "SonoParameters.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
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
  enum MatrixPlanes
  {
    WHOLE_VOLUME = 0,
    FIRST_PLANE = 1,
    SECOND_PLANE = 2
  };
  enum ImagingModes
  {
    FUNDAMENTAL = 0,
    HARMONIC = 1
  };

  ///@{
  /**
   * Layout and pulse. Units, ranges, defaults and what they do: sono::ScanGeometry and sono::ProbeSettings.
   */
  sonoParameter(ScanKind, int);
  sonoParameter(LineCount, int);
  sonoParameter(DepthMm, double);
  sonoParameter(SectorDeg, double);
  sonoParameter(RadiusMm, double);
  sonoParameter(WidthMm, double);
  sonoParameter(ElevationLineCount, int);
  sonoParameter(ElevationSectorDeg, double);
  sonoParameter(CentreFrequencyMHz, double);
  sonoParameter(FractionalBandwidth, double);
  sonoParameter(ApertureMm, double);
  sonoParameter(ElevationApertureMm, double);
  sonoParameter(TransmitFocusMm, double);
  sonoParameter(ElevationFocusMm, double);
  sonoParameter(ElementWidthMm, double);
  sonoParameter(ElementCount, int);
  sonoParameter(KerfMm, double);
  sonoParameter(AssumedSoundSpeedMPerS, double);
  sonoParameter(CompoundFans, int);
  sonoParameter(CompoundSpanDeg, double);
  sonoParameter(ImagingMode, int);
  sonoParameter(FacePressureKPa, double);
  ///@}

  /**
   * One of these by its name, as the panel's widget does for all of them.
   */
  void SetNumber(const char* name, double value);

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
   * What a matrix probe scans: all elevations, or one of two planes, as a biplane picture has them: the one along the
   * array, and the one across it, through the elevation sector. A plane has LineCount lines. Other kinds take no
   * notice. Default WHOLE_VOLUME.
   */
  vtkSetClampMacro(MatrixPlane, int, WHOLE_VOLUME, SECOND_PLANE);
  vtkGetMacro(MatrixPlane, int);
  ///@}

  ///@{
  /**
   * Whether the probe is being moved. On a GPU the stages then leave nothing out, but take 1000 paths a line at most;
   * on the CPU they make a coarse image quickly: every second of 120 lines and more, at most 40 paths a line, RF
   * sampled at four times the centre frequency at most, radial bins and pixels twice and scatterer cells up to twice as
   * wide as they are set to, a fifth of the scatterers, and surfaces in pieces of 2 mm. Default off.
   */
  vtkSetMacro(Preview, bool);
  vtkGetMacro(Preview, bool);
  vtkBooleanMacro(Preview, bool);
  ///@}

  /**
   * The Device of the stages that follow (vtkSonoRayTracer), which vtkSonoUltrasound hands on: whether a probe that is
   * being moved has a GPU. Without a word: Auto.
   */
  void UseDevice(int device);

  ///@{
  /**
   * A widget may move the probe: after each full image the anatomy is made ready for that in the background, which
   * takes memory and cores. Changes nothing in an image, so that nothing runs again for it. Default off.
   */
  void SetPrepareInteraction(bool prepare) { this->PrepareInteraction = prepare; }
  vtkGetMacro(PrepareInteraction, bool);
  ///@}

  ///@{
  /**
   * The probe, of the preset where one is named; or at another pose, moving or not. Throws sono::Error for what is out
   * of range.
   */
  sono::ProbeField Probe() const;
  sono::ProbeField ProbeAt(const double positionMm[3], const double axial[3], const double lateral[3],
                           bool preview) const;
  ///@}

protected:
  vtkSonoProbeSource();
  ~vtkSonoProbeSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoProbeSource(const vtkSonoProbeSource&) = delete;
  void operator=(const vtkSonoProbeSource&) = delete;

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::string PresetFile;
  double PositionMm[3] = { 87.8, -86.5, -45.0 };
  double Axial[3] = { -0.53, 0.65, 0.545 };
  double Lateral[3] = { 0.843, 0.333, 0.423 };
  int MatrixPlane = WHOLE_VOLUME;
  bool Preview = false;
  int Device = 0;
  bool PrepareInteraction = false;
};

#endif
