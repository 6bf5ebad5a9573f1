#ifndef vtkSonoStandardViews_h
#define vtkSonoStandardViews_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"      // for the rows
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

class vtkDataObject;
class vtkStringArray;
namespace sono {
class Scene;
}

/**
 * @class vtkSonoStandardViews
 * @brief Finds where a probe stands for the standard views of echocardiography and of the upper abdomen
 *
 * Takes a label image or a scene, like vtkSonoAcousticWindow, and looks for A4C, A2C, A3C, A5C, PLAX, PSAX base, PSAX
 * mid, PSAX apex, SC4C, IVC, RUQ, LUQ and Suprapubic by landmarks of the labels (sono::findStandardViews). The output
 * shows the way of the sound of the chosen view, a line in world coordinates, LPS mm, from the transducer's face to the
 * depth of the image. Its field data hold the pose (ProbePositionMm, ProbeAxial, ProbeLateral), and of all views that
 * are obtainable from this patient, a tuple each: ViewName, Sentence, ProbePreset, DepthMm, Score (0 to 1),
 * PlaneOffDegrees and MarkOffMm (off the ideal plane; from the apex, of a short axis from its level), ViewPositionMm,
 * ViewAxial, ViewLateral; of all others a sentence in Refused.
 */
class VTKSONOFILTERS_EXPORT vtkSonoStandardViews : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoStandardViews* New();
  vtkTypeMacro(vtkSonoStandardViews, vtkPolyDataAlgorithm);
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
   * The chosen view's name, as "A4C"; empty: the one with the best score. Default empty.
   */
  vtkSetStdStringFromCharMacro(View);
  vtkGetCharFromStdStringMacro(View);
  ///@}

  ///@{
  /**
   * After an update, as text: the views that are obtainable, in the order above, fields separated by tabs as those of
   * vtkSonoAcousticWindow; and a sentence for each of the others that says why it is not.
   */
  vtkStringArray* GetRows();
  vtkStringArray* GetRefusedRows();
  ///@}

  /**
   * Why there is no output, one sentence, which is also an error of the update; empty when there is.
   */
  const char* GetRefusal();

protected:
  vtkSonoStandardViews();
  ~vtkSonoStandardViews() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoStandardViews(const vtkSonoStandardViews&) = delete;
  void operator=(const vtkSonoStandardViews&) = delete;

  void Find(vtkDataObject* input, vtkPolyData* way);

  int FillBody = 2;
  std::string View;
  std::string Refusal;
  vtkSmartPointer<vtkStringArray> Rows;
  vtkSmartPointer<vtkStringArray> RefusedRows;
  std::shared_ptr<const sono::Scene> Scene; // for the picture that is made of it next
};

#endif
