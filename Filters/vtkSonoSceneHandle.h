#ifndef vtkSonoSceneHandle_h
#define vtkSonoSceneHandle_h

#include "vtkStringArray.h"

#include <memory>

class vtkFieldData;
class vtkMultiBlockDataSet;

namespace sono {
class Scene;
class TissueTable;
}

/**
 * @class vtkSonoSceneHandle
 * @brief Carries a shared sono::Scene and its tissue table from filter to filter inside field data
 *
 * Its one string is a summary for people. Copies of any depth share the scene. Where the data leave the process
 * (a file, another process) an ordinary string array is left, and the scene is gone.
 */
class vtkSonoSceneHandle : public vtkStringArray
{
public:
  static vtkSonoSceneHandle* New();
  vtkTypeMacro(vtkSonoSceneHandle, vtkStringArray);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Puts the scene of these blocks into their field data and remembers their bounds.
  static void Attach(std::shared_ptr<const sono::Scene> scene, std::shared_ptr<const sono::TissueTable> tissues,
                     vtkMultiBlockDataSet* blocks);

  /// The scene of the blocks. Throws sono::Error when they carry none, or were moved or cut since it was attached.
  static std::shared_ptr<const sono::Scene> Get(vtkMultiBlockDataSet* blocks);

  /// The scene that a later stage's field data carry. Throws sono::Error when there is none.
  static std::shared_ptr<const sono::Scene> Get(vtkFieldData* field);

  /// All tissues of the table that the scene was built with, for what is added to it. Throws as `Get`.
  static std::shared_ptr<const sono::TissueTable> GetTissues(vtkFieldData* field);

  void DeepCopy(vtkAbstractArray* other) override;

protected:
  vtkSonoSceneHandle();
  ~vtkSonoSceneHandle() override;

private:
  vtkSonoSceneHandle(const vtkSonoSceneHandle&) = delete;
  void operator=(const vtkSonoSceneHandle&) = delete;

  static vtkSonoSceneHandle* Need(vtkFieldData* field);
  static vtkSonoSceneHandle* Find(vtkFieldData* field);

  std::shared_ptr<const sono::Scene> Scene;
  std::shared_ptr<const sono::TissueTable> Tissues;
  double Bounds[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
};

#endif
