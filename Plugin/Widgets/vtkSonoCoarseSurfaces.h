#ifndef vtkSonoCoarseSurfaces_h
#define vtkSonoCoarseSurfaces_h

#include "vtkCellArray.h"         // for what is kept
#include "vtkMultiBlockDataSet.h" // for what is kept
#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkNew.h"               // for what is kept
#include "vtkPoints.h"            // for what is kept
#include "vtkSmartPointer.h"      // for what is kept
#include "vtkSonoWidgetsModule.h" // for export macro

#include <vector>

/**
 * @class vtkSonoCoarseSurfaces
 * @brief What of some surfaces a probe can be moved along with, small enough for a link between server and client
 *
 * One block for each mesh of the input that has polygons, without arrays: of the corners in each cube of CubeMm one is
 * left. While the input hands on the same meshes, as when a setting of its filter has changed that they do not depend
 * on, so does this.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoCoarseSurfaces : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkSonoCoarseSurfaces* New();
  vtkTypeMacro(vtkSonoCoarseSurfaces, vtkMultiBlockDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of the cubes in mm, 0.1 to 100. Default 6.
   */
  vtkSetClampMacro(CubeMm, double, 0.1, 100.0);
  vtkGetMacro(CubeMm, double);
  ///@}

  /**
   * How often the blocks were made anew so far.
   */
  vtkGetMacro(Version, int);

protected:
  vtkSonoCoarseSurfaces() = default;
  ~vtkSonoCoarseSurfaces() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoCoarseSurfaces(const vtkSonoCoarseSurfaces&) = delete;
  void operator=(const vtkSonoCoarseSurfaces&) = delete;

  /// What a mesh is made of.
  struct Shape
  {
    vtkSmartPointer<vtkPoints> points;
    vtkSmartPointer<vtkCellArray> polygons;
    vtkMTimeType time;
  };
  bool IsMadeOf(const std::vector<Shape>& shapes) const;

  double CubeMm = 6.0;
  int Version = 0;
  double MadeCubeMm = 0.0;
  std::vector<Shape> Made;
  vtkNew<vtkMultiBlockDataSet> Kept;
};

#endif
