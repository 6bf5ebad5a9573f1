#ifndef vtkSonoImageMapper_h
#define vtkSonoImageMapper_h

#include "vtkNew.h"
#include "vtkPVImageSliceMapper.h"
#include "vtkSmartPointer.h"
#include "vtkSonoWidgetsModule.h" // for export macro
#include "vtkTimeStamp.h"
#include "vtkWeakPointer.h"

class vtkActor;
class vtkDataArray;
class vtkImageSliceRepresentation;
class vtkOpenGLRenderWindow;
class vtkOpenGLTexture;
class vtkPoints;
class vtkSonoGpuTexture;
class vtkTextureObject;
class vtkUnsignedCharArray;

/**
 * @class vtkSonoImageMapper
 * @brief Draws an image from the memory of the GPU that made it, where that draws the window as well
 *
 * Greys of one byte in a plane, coloured by a table, which lie on a GPU (vtkSonoGpuTexture) go into a texture there and
 * do not come to the host. All else is drawn as ParaView's slices are.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoImageMapper : public vtkPVImageSliceMapper
{
public:
  static vtkSonoImageMapper* New();
  vtkTypeMacro(vtkSonoImageMapper, vtkPVImageSliceMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Draws what the representation shows, from now on. Without a GPU it stays as it is.
   */
  static void UseIn(vtkImageSliceRepresentation* representation);

  /**
   * Pictures that did not come to the host.
   */
  vtkGetMacro(PicturesOnGpu, int);

  void Render(vtkRenderer* renderer, vtkActor* actor) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkSonoImageMapper();
  ~vtkSonoImageMapper() override;

private:
  vtkSonoImageMapper(const vtkSonoImageMapper&) = delete;
  void operator=(const vtkSonoImageMapper&) = delete;

  vtkUnsignedCharArray* Greys(vtkImageData* image);
  bool Open(vtkOpenGLRenderWindow* window, int width, int height);
  void Close();
  bool Fill(vtkImageData* image, vtkUnsignedCharArray* greys);
  void Place(vtkImageData* image);
  bool RenderOnGpu(vtkRenderer* renderer, vtkActor* actor);

  vtkNew<vtkSonoGpuTexture> Gpu;
  vtkNew<vtkTextureObject> Texels;
  vtkNew<vtkOpenGLTexture> Shown; ///< the texels, as actors take them
  vtkNew<vtkPoints> Corners;
  vtkNew<vtkActor> Quad;
  vtkWeakPointer<vtkOpenGLRenderWindow> Window; ///< that was asked last
  int Width = 0;
  int Height = 0;
  vtkTimeStamp FillTime;
  int PicturesOnGpu = 0;
};

#endif
