#ifndef vtkSonoResultHandle_h
#define vtkSonoResultHandle_h

#include "vtkStringArray.h"

#include <any>
#include <vector>

class vtkAbstractArray;
class vtkFieldData;

/**
 * @class vtkSonoResultHandle
 * @brief Carries a stage's result from filter to filter inside field data, where it lies
 *
 * The arrays beside it are the result on the host. As long as they are the ones that it was attached with, the next
 * stage may take the result in their place, and on a GPU need not bring them there again; a handle that has come away
 * from them, or whose arrays were changed, is not found. Copies of any depth share the result. Where the data leave the
 * process an ordinary string array is left.
 */
class vtkSonoResultHandle : public vtkStringArray
{
public:
  static vtkSonoResultHandle* New();
  vtkTypeMacro(vtkSonoResultHandle, vtkStringArray);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Replaces the handle of a stage before, if there is one.
  static void Attach(std::any result, const std::vector<vtkAbstractArray*>& arrays, vtkFieldData* field);
  /// No handle any more.
  static void Remove(vtkFieldData* field);

  /// The result of that type which these arrays are; null where there is none. Null arrays are no result's.
  template<class Result>
  static const Result* Find(const std::vector<vtkAbstractArray*>& arrays, vtkFieldData* field)
  {
    const std::any* held = FindAny(arrays, field);
    return held ? std::any_cast<Result>(held) : nullptr;
  }

  void DeepCopy(vtkAbstractArray* other) override;

protected:
  vtkSonoResultHandle();
  ~vtkSonoResultHandle() override;

private:
  vtkSonoResultHandle(const vtkSonoResultHandle&) = delete;
  void operator=(const vtkSonoResultHandle&) = delete;

  static const std::any* FindAny(const std::vector<vtkAbstractArray*>& arrays, vtkFieldData* field);

  std::any Result;
  std::vector<vtkMTimeType> Times; // of the arrays; unique, so that equal ones mean the same arrays, unchanged
};

#endif
