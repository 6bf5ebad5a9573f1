#ifndef vtkSonoCoarseSurfaces_h
#define vtkSonoCoarseSurfaces_h

#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkSonoWidgetsModule.h" // for export macro

/**
 * @class vtkSonoCoarseSurfaces
 * @brief What of some surfaces a probe can be moved along with, small enough for a link between server and client
 *
 * One block for each mesh of the input that has polygons, without arrays: of the corners in each cube of CubeMm one is
 * left.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoCoarseSurfaces : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkSonoCoarseSurfaces* New();
  vtkTypeMacro(vtkSonoCoarseSurfaces, vtkMultiBlockDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of the cubes in mm, 0.1 to 100. Default 4.
   */
  vtkSetClampMacro(CubeMm, double, 0.1, 100.0);
  vtkGetMacro(CubeMm, double);
  ///@}

protected:
  vtkSonoCoarseSurfaces() = default;
  ~vtkSonoCoarseSurfaces() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoCoarseSurfaces(const vtkSonoCoarseSurfaces&) = delete;
  void operator=(const vtkSonoCoarseSurfaces&) = delete;

  double CubeMm = 4.0;
};

#endif
