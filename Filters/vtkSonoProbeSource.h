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
 * The output shows the outline of the scanned area (cell 0) and the transducer's face (cell 1) in world coordinates,
 * LPS mm. Its field data hold everything that later stages need of the probe.
 */
class VTKSONOFILTERS_EXPORT vtkSonoProbeSource : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoProbeSource* New();
  vtkTypeMacro(vtkSonoProbeSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * A preset (JSON) that gives layout and pulse; where it is empty, the numbers below do. Default empty.
   */
  vtkSetStdStringFromCharMacro(PresetFile);
  vtkGetCharFromStdStringMacro(PresetFile);
  ///@}

  enum ScanKinds
  {
    LINEAR = 0,
    PHASED_SECTOR = 1,
    CURVILINEAR = 2
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
   * Number of scan lines, 1 to 4096. Default 128.
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
   * Angle between the outermost lines in degrees, between 0 and 180; not for linear probes. Default 90.
   */
  vtkSetMacro(SectorDeg, double);
  vtkGetMacro(SectorDeg, double);
  ///@}

  ///@{
  /**
   * Radius of a curvilinear probe's face in mm, above 0. Default 60.
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
   * Centre of the transducer's face in world coordinates, LPS mm. Default (0, 0, 0).
   */
  vtkSetVector3Macro(PositionMm, double);
  vtkGetVector3Macro(PositionMm, double);
  ///@}

  ///@{
  /**
   * Direction into the body, of any length above 0. Default (0, 0, 1).
   */
  vtkSetVector3Macro(Axial, double);
  vtkGetVector3Macro(Axial, double);
  ///@}

  ///@{
  /**
   * Direction along the array, not parallel to Axial; made orthogonal to it. Default (1, 0, 0).
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
  double PositionMm[3] = { 0.0, 0.0, 0.0 };
  double Axial[3] = { 0.0, 0.0, 1.0 };
  double Lateral[3] = { 1.0, 0.0, 0.0 };
  double CentreFrequencyMHz = 2.5;
  double FractionalBandwidth = 0.6;
};

#endif
