#include "vtkSonoGpuImage.h"

#include "DataSets/DataSetImager.h"
#include "DataSets/ImageTensor.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoGpuImage);

vtkSonoGpuImage::vtkSonoGpuImage() = default;

vtkSonoGpuImage::~vtkSonoGpuImage() = default;

void vtkSonoGpuImage::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Width: " << this->Width << endl;
  os << indent << "Height: " << this->Height << endl;
  os << indent << "Device: " << this->Device << endl;
}

vtkTypeUInt64 vtkSonoGpuImage::NewTensor(const std::string& name, vtkTypeUInt64 stream)
{
  const auto bytes = name == "BMode" ? this->BMode : name == "Mask" ? this->Mask : nullptr;
  return bytes ? reinterpret_cast<std::uintptr_t>(sono::newTensor(*bytes, this->Height, this->Width, stream)) : 0;
}

void vtkSonoGpuImage::DeleteTensor(vtkTypeUInt64 address)
{
  sono::deleteTensor(reinterpret_cast<DLManagedTensor*>(static_cast<std::uintptr_t>(address)));
}

vtkSonoGpuImage* vtkSonoGpuImage::NewFrom(const sono::DataSetImage& image)
{
  if (!image.greyOnGpu)
  {
    return nullptr;
  }
  vtkSonoGpuImage* made = vtkSonoGpuImage::New();
  made->Width = image.width;
  made->Height = image.height;
  made->Device = image.greyOnGpu->device;
  made->BMode = image.greyOnGpu;
  made->Mask = image.maskOnGpu;
  return made;
}
