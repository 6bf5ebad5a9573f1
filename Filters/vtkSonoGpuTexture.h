#ifndef vtkSonoGpuTexture_h
#define vtkSonoGpuTexture_h

#include "vtkObject.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

class vtkUnsignedCharArray;

namespace sono {
class GreyTexture;
}

/**
 * @class vtkSonoGpuTexture
 * @brief A texture of OpenGL that the GPU which made a picture fills with it, without the host
 *
 * Open, filled, closed and deleted where the texture's context is current.
 */
class VTKSONOFILTERS_EXPORT vtkSonoGpuTexture : public vtkObject
{
public:
  static vtkSonoGpuTexture* New();
  vtkTypeMacro(vtkSonoGpuTexture, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Whether this process can compute on a GPU.
   */
  static bool CanBe();

  /**
   * Takes a texture with memory for width x height texels of four bytes, by OpenGL's name of it, until Close(). False
   * where it is not drawn by a GPU that CUDA can use.
   */
  bool Open(unsigned int name, int width, int height);
  void Close();
  bool IsOpen() const { return this->Texture != nullptr; }

  /**
   * The colours (256 of red, green, blue and opacity) of the greys. False where these do not lie on a GPU, or it fails.
   */
  bool Fill(vtkUnsignedCharArray* greys, vtkUnsignedCharArray* colors);

  /**
   * Whether an array lies on a GPU: pictures of Simulate Ultrasound and Scan Conversion since KeepPictures().
   */
  static bool Holds(vtkUnsignedCharArray* greys);

  /**
   * From now on pictures made on a GPU stay there until somebody on the host reads them.
   */
  static void KeepPictures();

protected:
  vtkSonoGpuTexture();
  ~vtkSonoGpuTexture() override;

private:
  vtkSonoGpuTexture(const vtkSonoGpuTexture&) = delete;
  void operator=(const vtkSonoGpuTexture&) = delete;

  std::unique_ptr<sono::GreyTexture> Texture;
  int Width = 0;
  int Height = 0;
};

#endif
