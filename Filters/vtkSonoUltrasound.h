#ifndef vtkSonoUltrasound_h
#define vtkSonoUltrasound_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

/**
 * @class vtkSonoUltrasound
 * @brief Simulates ultrasound from a label map, all stages in one
 *
 * Chains vtkSonoSceneBuilder, vtkSonoProbeSource, vtkSonoRayTracer, vtkSonoImageFormation, vtkSonoBMode and
 * vtkSonoScanConverter, and runs again only those that a change concerns. The input is a label image, or a scene that
 * vtkSonoSceneBuilder or vtkSonoSceneReader made; then the settings of the scene are not used.
 *
 * Outputs: 0 the image in the world (of vtkSonoScanConverter), 1 the B-mode lines, 2 the RF lines, 3 the traced lines
 * with their standard error, 4 the anatomy (of vtkSonoSceneBuilder), 5 the probe (of vtkSonoProbeSource), 6 the ray
 * paths, 7 the image in the probe's own frame, mm, 8 the error map (of vtkSonoErrorMap),
 * 9 the boundaries that the ray paths met. (ParaView has room for no more than ten.)
 *
 * The error map is empty unless ErrorMap is on. The two images have its array "ErrorPercent" then, too.
 *
 * Settings have the names, units, ranges and defaults of the stages, where they are described, but for these defaults,
 * which suit a chest: MaxCollisions 20, CoherenceMm 20, LobeSigmaDeg 6, TgcDbPerCm 3. Seed is that of the paths and of
 * the scatterers.
 */
class VTKSONOFILTERS_EXPORT vtkSonoUltrasound : public vtkImageAlgorithm
{
public:
  static vtkSonoUltrasound* New();
  vtkTypeMacro(vtkSonoUltrasound, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutputPorts
  {
    IMAGE = 0,
    BMODE_LINES = 1,
    RF_LINES = 2,
    TRACED_LINES = 3,
    ANATOMY = 4,
    PROBE = 5,
    RAY_PATHS = 6,
    FLAT_IMAGE = 7,
    ERROR_MAP = 8,
    BOUNDARY_HITS = 9
  };

  ///@{
  /**
   * The scene, see vtkSonoSceneBuilder.
   */
  void SetTissueTableFile(const char* value);
  const char* GetTissueTableFile();
  void SetLabelTissueFile(const char* value);
  const char* GetLabelTissueFile();
  void SetLabelTableFile(const char* value);
  const char* GetLabelTableFile();
  void SetFallbackTissue(const char* value);
  const char* GetFallbackTissue();
  void SetOutsideTissue(const char* value);
  const char* GetOutsideTissue();
  void SetFillBody(bool value);
  bool GetFillBody();
  void SetClosingMm(double value);
  double GetClosingMm();
  void SetWallMm(double value);
  double GetWallMm();
  void SetSkinMm(double value);
  double GetSkinMm();
  void SetCacheFolder(const char* value);
  const char* GetCacheFolder();
  void SetBuildSurfaces(bool value);
  bool GetBuildSurfaces();
  ///@}

  ///@{
  /**
   * The probe, see vtkSonoProbeSource.
   */
  void SetPresetFile(const char* value);
  const char* GetPresetFile();
  void SetScanKind(int value);
  int GetScanKind();
  void SetLineCount(int value);
  int GetLineCount();
  void SetDepthMm(double value);
  double GetDepthMm();
  void SetSectorDeg(double value);
  double GetSectorDeg();
  void SetRadiusMm(double value);
  double GetRadiusMm();
  void SetWidthMm(double value);
  double GetWidthMm();
  void SetElevationLineCount(int value);
  int GetElevationLineCount();
  void SetElevationSectorDeg(double value);
  double GetElevationSectorDeg();
  void SetPositionMm(double x, double y, double z);
  double* GetPositionMm() VTK_SIZEHINT(3);
  void SetAxial(double x, double y, double z);
  double* GetAxial() VTK_SIZEHINT(3);
  void SetLateral(double x, double y, double z);
  double* GetLateral() VTK_SIZEHINT(3);
  void SetCentreFrequencyMHz(double value);
  double GetCentreFrequencyMHz();
  void SetFractionalBandwidth(double value);
  double GetFractionalBandwidth();
  void SetPreview(bool value);
  bool GetPreview();
  ///@}

  ///@{
  /**
   * The paths, see vtkSonoRayTracer.
   */
  void SetInterfaceModel(int value);
  int GetInterfaceModel();
  void SetDevice(int value);
  int GetDevice();
  void SetSampling(int value);
  int GetSampling();
  void SetPathsPerLine(int value);
  int GetPathsPerLine();
  void SetMaxCollisions(int value);
  int GetMaxCollisions();
  void SetCoherenceMm(double value);
  double GetCoherenceMm();
  void SetDeterministic(bool value);
  bool GetDeterministic();
  void SetLobeMeanDeg(double value);
  double GetLobeMeanDeg();
  void SetLobeSigmaDeg(double value);
  double GetLobeSigmaDeg();
  void SetLobeMinDeg(double value);
  double GetLobeMinDeg();
  void SetLobeMaxDeg(double value);
  double GetLobeMaxDeg();
  void SetRadialBinMm(double value);
  double GetRadialBinMm();
  void SetSamplingMHz(double value);
  double GetSamplingMHz();
  void SetRouletteDb(double value);
  double GetRouletteDb();
  void SetNumberOfShownPaths(int value);
  int GetNumberOfShownPaths();
  void SetSeed(int value);
  int GetSeed();
  ///@}

  ///@{
  /**
   * The echoes, see vtkSonoImageFormation.
   */
  void SetLateralSigmaMm(double value);
  double GetLateralSigmaMm();
  void SetElevationalSigmaMm(double value);
  double GetElevationalSigmaMm();
  void SetScattererCellMm(double value);
  double GetScattererCellMm();
  void SetScattererLevelDb(double value);
  double GetScattererLevelDb();
  void SetPulseFileName(const char* value);
  const char* GetPulseFileName();
  ///@}

  ///@{
  /**
   * The grey, see vtkSonoBMode.
   */
  void SetTgcDbPerCm(double value);
  double GetTgcDbPerCm();
  void AddTgcPoint(double depthMm, double gainDb);
  void RemoveAllTgcPoints();
  int GetNumberOfTgcPoints();
  void SetGainDb(double value);
  double GetGainDb();
  void SetAutomaticReference(bool value);
  bool GetAutomaticReference();
  void SetReferenceAmplitude(double value);
  double GetReferenceAmplitude();
  void SetDynamicRangeDb(double value);
  double GetDynamicRangeDb();
  void SetRejectDb(double value);
  double GetRejectDb();
  void SetGreyMap(int value);
  int GetGreyMap();
  void SetAddNoise(bool value);
  bool GetAddNoise();
  void SetNoiseDb(double value);
  double GetNoiseDb();
  void SetNoiseSeed(int value);
  int GetNoiseSeed();
  ///@}

  ///@{
  /**
   * The image, see vtkSonoScanConverter.
   */
  void SetPixelMm(double value);
  double GetPixelMm();
  ///@}

  ///@{
  /**
   * Whether to make the error map, see vtkSonoErrorMap. Default off.
   */
  vtkSetMacro(ErrorMap, bool);
  vtkGetMacro(ErrorMap, bool);
  vtkBooleanMacro(ErrorMap, bool);
  ///@}

protected:
  vtkSonoUltrasound();
  ~vtkSonoUltrasound() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoUltrasound(const vtkSonoUltrasound&) = delete;
  void operator=(const vtkSonoUltrasound&) = delete;

  class Stages;
  std::unique_ptr<Stages> Chain;
  bool ErrorMap = false;

  template<class Stage, class Change>
  void ChangeStage(Stage* stage, const Change& change);
};

#endif
