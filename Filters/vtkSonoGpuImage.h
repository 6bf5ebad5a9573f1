#ifndef vtkSonoGpuImage_h
#define vtkSonoGpuImage_h

#include "vtkObject.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
struct DataSetImage;
struct DeviceBytes;
}

/**
 * @class vtkSonoGpuImage
 * @brief An image of a data set and its mask in a GPU's memory, for programs of this process that read them there
 *
 * They are handed over by DLPack: sonovdb.Dataset makes Python's capsules of the tensors. The memory is kept while this
 * lives or a tensor does.
 */
class VTKSONOFILTERS_EXPORT vtkSonoGpuImage : public vtkObject
{
public:
  static vtkSonoGpuImage* New();
  vtkTypeMacro(vtkSonoGpuImage, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Pixels, and CUDA's number of the device.
   */
  vtkGetMacro(Width, int);
  vtkGetMacro(Height, int);
  vtkGetMacro(Device, int);
  ///@}

  /**
   * The address of a new DLManagedTensor, Height x Width of uint8: "BMode" or "Mask", 0 where it is neither. Whoever
   * takes it calls its deleter, after which its memory is used again when all is done that a stream of CUDA's (its
   * handle, 1 for the default one) has been asked for.
   */
  vtkTypeUInt64 NewTensor(const std::string& name, vtkTypeUInt64 stream);
  /**
   * Calls the deleter of a tensor that nobody has taken.
   */
  static void DeleteTensor(vtkTypeUInt64 address);

#ifndef __VTK_WRAP__
  /// Null where the image is not on a GPU.
  static vtkSonoGpuImage* NewFrom(const sono::DataSetImage& image);
#endif

protected:
  vtkSonoGpuImage();
  ~vtkSonoGpuImage() override;

private:
  vtkSonoGpuImage(const vtkSonoGpuImage&) = delete;
  void operator=(const vtkSonoGpuImage&) = delete;

  int Width = 0;
  int Height = 0;
  int Device = 0;
  std::shared_ptr<const sono::DeviceBytes> BMode;
  std::shared_ptr<const sono::DeviceBytes> Mask;
};

#endif
