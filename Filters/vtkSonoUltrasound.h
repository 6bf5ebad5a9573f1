#ifndef vtkSonoUltrasound_h
#define vtkSonoUltrasound_h

#include "vtkImageAlgorithm.h"
#include "vtkSmartPointer.h"      // for the stages
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
class UltrasoundStages;
}
class vtkSonoBMode;
class vtkSonoImageFormation;
class vtkSonoProbeSource;
class vtkSonoRayTracer;
class vtkSonoScanConverter;
class vtkSonoSceneBuilder;

/**
 * @class vtkSonoUltrasound
 * @brief Simulates ultrasound from a label map, all stages in one
 *
 * Does what vtkSonoSceneBuilder, vtkSonoProbeSource, vtkSonoRayTracer, vtkSonoImageFormation, vtkSonoBMode and
 * vtkSonoScanConverter do one after the other, by one sono::Simulator, and again only what a change concerns. Input 0
 * is a label image, or a scene that vtkSonoSceneBuilder or vtkSonoSceneReader made; then the settings of the scene are
 * not used. Optional inputs, as the stages describe them: 1 targets (of vtkSonoRayTracer), 2 point scatterers and 3 a
 * pulse-echo field (of vtkSonoImageFormation).
 *
 * Outputs: 0 the image in the world (of vtkSonoScanConverter), 1 the B-mode lines, 2 the RF lines, 3 the traced lines
 * with their standard error, 4 the anatomy (of vtkSonoSceneBuilder), 5 the probe (of vtkSonoProbeSource), 6 the ray
 * paths, 7 the image in the probe's own frame, mm, 8 the error map (of vtkSonoErrorMap),
 * 9 the boundaries that the ray paths met. (ParaView has room for no more than ten.)
 *
 * The images, the traced lines and the error map carry the field arrays "TracedPaths" and, with a target error or a
 * time budget, "ErrorDb": what was reached. The error map is empty unless ErrorMap is on. The two images have its array
 * "ErrorPercent" then, too.
 *
 * The settings are those of the stages: ask for a stage, and set it up. They have the stages' defaults but for those
 * of ChestDefaults.h. The ray tracer's Device is that of all stages, the scan converter's PixelMm that of the error
 * map.
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

  enum InputPorts
  {
    LABELS_OR_SCENE = 0,
    TARGETS = 1,
    SCATTERERS = 2,
    PULSE_ECHO_FIELD = 3
  };

  ///@{
  /**
   * The stages, which have the settings. One that is given takes the place of the filter's own; null is ignored. A
   * stage belongs to one filter: its inputs and outputs are connected here.
   */
  void SetSceneBuilder(vtkSonoSceneBuilder* stage);
  vtkSonoSceneBuilder* GetSceneBuilder();
  void SetProbe(vtkSonoProbeSource* stage);
  vtkSonoProbeSource* GetProbe();
  void SetRayTracer(vtkSonoRayTracer* stage);
  vtkSonoRayTracer* GetRayTracer();
  void SetImageFormation(vtkSonoImageFormation* stage);
  vtkSonoImageFormation* GetImageFormation();
  void SetBMode(vtkSonoBMode* stage);
  vtkSonoBMode* GetBMode();
  void SetScanConverter(vtkSonoScanConverter* stage);
  vtkSonoScanConverter* GetScanConverter();
  ///@}

  /**
   * A change of a stage is a change of this filter.
   */
  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * Whether to make the error map, see vtkSonoErrorMap. Default off.
   */
  vtkSetMacro(ErrorMap, bool);
  vtkGetMacro(ErrorMap, bool);
  vtkBooleanMacro(ErrorMap, bool);
  ///@}

  ///@{
  /**
   * A number, 1 or more, that filters have in common which hold one probe; 0: none. It changes no image: a program that
   * shows them keeps their probes alike. Default 0.
   */
  void SetSharedProbe(int number) { this->SharedProbe = number; }
  vtkGetMacro(SharedProbe, int);
  ///@}

  ///@{
  /**
   * What a program that shows the filter as a scanner does with it; they change no image. Freeze: whether the picture
   * stays while the probe moves and is set, default off. StoreFolder: where pictures of it are written, default "":
   * whoever writes one asks. HeartRate: how many times a minute all time steps are played, 20 to 300, or 0, the
   * default: as many as their times say.
   */
  void SetFreeze(bool frozen) { this->Freeze = frozen; }
  vtkGetMacro(Freeze, bool);
  void SetStoreFolder(const char* folder) { this->StoreFolder = folder ? folder : ""; }
  const char* GetStoreFolder() { return this->StoreFolder.c_str(); }
  void SetHeartRate(double rate) { this->HeartRate = rate; }
  vtkGetMacro(HeartRate, double);
  ///@}

  ///@{
  /**
   * With a target error or a time budget of the tracer, whether a picture of the first round of paths is made at once
   * and the others are traced in the background, until another picture is wanted: HasBetter says whether there is a
   * better one, IsRefining whether one may follow. An Update makes a better one once HasBetter has said so; all outputs
   * are of the same paths until it is asked again. Off, an Update gives the last one; it waits for what is under way.
   * Default off: for whoever looks on.
   */
  void SetProgressive(bool progressive);
  vtkGetMacro(Progressive, bool);
  vtkBooleanMacro(Progressive, bool);
  bool IsRefining();
  bool HasBetter();
  ///@}

  /**
   * Begins in the background what the first picture of a moving probe needs (Scene::beginInteractiveRegion), for a
   * picture that was made; changes none. For a GUI, when nothing else is to be done.
   */
  void PrepareMoving();

  ///@{
  /**
   * For a GUI that draws one picture of a moving probe while the next is computed. MakeAhead begins, in the background,
   * the image of a moving probe at another pose; if one is under way, when that has been asked for. False where it does
   * not: no image was made yet, it is made by a pulse from a file, or a GPU makes it. An Update with Preview at that
   * pose takes the image over, which is the same as without; another one drops it. IsAheadReady says whether an Update
   * would not have to wait for it.
   */
  bool MakeAhead(const double positionMm[3], const double axial[3], const double lateral[3]);
  bool IsAheadReady();
  ///@}

  /**
   * An output is made when it is asked for: the images by Update(), another by Update(port).
   */
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** input,
                             vtkInformationVector* output) override;

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

  template<class Stage>
  void Replace(vtkSmartPointer<Stage>& own, Stage* given);

  std::unique_ptr<sono::UltrasoundStages> Inside;
  bool ErrorMap = false;
  int SharedProbe = 0;
  bool Freeze = false;
  std::string StoreFolder;
  double HeartRate = 0.0;
  bool Progressive = false;
};

#endif
