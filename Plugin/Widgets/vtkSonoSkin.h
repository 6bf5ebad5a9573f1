#ifndef vtkSonoSkin_h
#define vtkSonoSkin_h

#include "vtkObject.h"
#include "vtkSonoWidgetsModule.h" // for export macro

#include <memory>
#include <vector>

class SonoSkinSurface;
class vtkDataObject;

/**
 * @class vtkSonoSkin
 * @brief The surfaces that a probe can stand on: where a line meets them, and their normal there
 *
 * The normal is the mean over a disc about as large as a transducer's face, so that the steps and the noise of a mesh
 * do not shake the probe. Triangles that face the other way do not count in it: the skin of a label map is a thin shell
 * with an inner side close behind the outer one.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoSkin : public vtkObject
{
public:
  static vtkSonoSkin* New();
  vtkTypeMacro(vtkSonoSkin, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Takes the polygons of a dataset, or of all leaves of a composite one, instead of those before; null: none. A
   * surface is sorted for searching when it is first asked, and stays so while it is among them.
   */
  void SetSurfaces(vtkDataObject* surfaces);

  /**
   * Sorts all surfaces now, so that the first question need not wait for it.
   */
  void Prepare();

  /**
   * How many surfaces have been sorted so far.
   */
  vtkGetMacro(NumberOfSorts, int);

  /**
   * Whether there is no polygon at all.
   */
  bool IsEmpty() const { return this->Surfaces.empty(); }

  /**
   * The first place where the way from `from` to `to` meets a surface, and the smoothed unit normal there, on the side
   * that the way came from. False where it meets none; the results are then left alone.
   */
  bool Meet(const double from[3], const double to[3], double position[3], double normal[3]);

  /**
   * The place nearest to `point` and the smoothed unit normal there, on the side of `point`. False where there is no
   * surface at all.
   */
  bool FindNearest(const double point[3], double position[3], double normal[3]);

  /**
   * Bounds of all surfaces; uninitialized where there are none.
   */
  void GetBounds(double bounds[6]) const;

  ///@{
  /**
   * Radius in mm of the disc that a normal is the mean of, at least 0; its rim counts less than its middle. Default 10.
   */
  vtkSetClampMacro(SmoothingMm, double, 0.0, 1000.0);
  vtkGetMacro(SmoothingMm, double);
  ///@}

protected:
  vtkSonoSkin();
  ~vtkSonoSkin() override;

private:
  vtkSonoSkin(const vtkSonoSkin&) = delete;
  void operator=(const vtkSonoSkin&) = delete;

  void Sort(SonoSkinSurface& surface);

  std::vector<std::shared_ptr<SonoSkinSurface>> Surfaces;
  int NumberOfSorts = 0;
  double SmoothingMm = 10.0;
};

#endif
