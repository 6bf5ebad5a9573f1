#ifndef vtkSonoAcousticWindow_h
#define vtkSonoAcousticWindow_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"      // for the rows
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>
#include <vector>

class vtkStringArray;
namespace sono {
class Scene;
}

/**
 * @class vtkSonoAcousticWindow
 * @brief Finds places on the skin from which a probe sees the heart, or another organ
 *
 * Takes a label image or a scene, like vtkSonoUltrasound, and offers up to five places, best first, with what is seen
 * from each (sono::findAcousticWindows). The output shows the way of the sound from the chosen one, a line in world
 * coordinates, LPS mm, from the transducer's face to the depth of the image. Its field data hold the pose:
 * ProbePositionMm, ProbeAxial and ProbeLateral, and of all places, a tuple each, CandidatePositionMm, CandidateAxial,
 * CandidateLateral, DepthMm, SeenPercent (of the target's largest section), LossDb (mean, one way), InsidePercent (of
 * the image in the label map's box), Sentence and ProbePreset (the bundled preset for this target; empty: any).
 *
 * Guesses and a filled body are not said here but by the filter that makes a picture or a scene of the label image.
 *
 * A label image may bring a pose of its own along in its field data (A4CPositionMm, A4CAxial, A4CLateral, as the
 * bundled thorax does), which is then the only answer, unless a target is named.
 */
class VTKSONOFILTERS_EXPORT vtkSonoAcousticWindow : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoAcousticWindow* New();
  vtkTypeMacro(vtkSonoAcousticWindow, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the body of a label image is filled first, see vtkSonoSceneBuilder. Default 2, automatic.
   */
  vtkSetClampMacro(FillBody, int, 0, 2);
  vtkGetMacro(FillBody, int);
  ///@}

  ///@{
  /**
   * What the probe looks at: an organ ("heart", "right kidney", "carotid") or any label by words of its name; empty:
   * the heart, where there is none the liver, instead of its tip a kidney, else the body. Default empty.
   */
  vtkSetStdStringFromCharMacro(Target);
  vtkGetCharFromStdStringMacro(Target);
  ///@}

  ///@{
  /**
   * Which of the places, from 0, the best, to 4. Default 0.
   */
  vtkSetClampMacro(Candidate, int, 0, 4);
  vtkGetMacro(Candidate, int);
  ///@}

  ///@{
  /**
   * Whether the probe looks at TargetMm instead of Target. Default off.
   */
  vtkSetMacro(ChooseTarget, bool);
  vtkGetMacro(ChooseTarget, bool);
  vtkBooleanMacro(ChooseTarget, bool);
  ///@}

  ///@{
  /**
   * What the probe looks at, in world coordinates, LPS mm, within the body. Used with ChooseTarget. Default (0, 0, 0).
   */
  vtkSetVector3Macro(TargetMm, double);
  vtkGetVector3Macro(TargetMm, double);
  ///@}

  ///@{
  /**
   * Frequency in MHz, above 0, for which tissues attenuate where the target has no probe of its own. Default 2.5.
   */
  vtkSetMacro(CentreFrequencyMHz, double);
  vtkGetMacro(CentreFrequencyMHz, double);
  ///@}

  ///@{
  /**
   * Folder that keeps what was found, by the content of the label map's files and all settings, as of
   * vtkSonoSceneBuilder: "auto" the user's own; empty keeps nothing. Default auto.
   */
  vtkSetStdStringFromCharMacro(CacheFolder);
  vtkGetCharFromStdStringMacro(CacheFolder);
  ///@}

  ///@{
  /**
   * After an update, as text: the places, fields separated by tabs (sentence, preset, DepthMm, and three numbers each
   * of position, axial and lateral; a pose that the data bring along has the depth 0), and the names of possible
   * targets.
   */
  vtkStringArray* GetRows();
  vtkStringArray* GetTargets();
  ///@}

  /**
   * Why there are none, one sentence, which is also an error of the update; empty when there are.
   */
  const char* GetRefusal();

protected:
  vtkSonoAcousticWindow();
  ~vtkSonoAcousticWindow() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoAcousticWindow(const vtkSonoAcousticWindow&) = delete;
  void operator=(const vtkSonoAcousticWindow&) = delete;

  void Find(vtkDataObject* input, vtkPolyData* way);
  std::string KeptKey();
  bool TakeKept(vtkPolyData* way);
  void Keep(vtkPolyData* way);

  int FillBody = 2;
  std::string Target;
  int Candidate = 0;
  bool ChooseTarget = false;
  double TargetMm[3] = { 0.0, 0.0, 0.0 };
  double CentreFrequencyMHz = 2.5;
  std::string CacheFolder = "auto";
  std::string Refusal;
  vtkSmartPointer<vtkStringArray> Rows;
  vtkSmartPointer<vtkStringArray> Targets;
  std::shared_ptr<const sono::Scene> Scene; // for the picture that is made of it next
  std::string Key;                          // of what is wanted; empty: it is not to be kept
  std::vector<std::string> Kept;            // what was found earlier; empty: nothing
};

#endif
