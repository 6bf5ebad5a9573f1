#include "vtkSonoGpuTexture.h"

#include "Cuda/DeviceImager.h"
#include "Cuda/GreyTexture.h"

#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

vtkStandardNewMacro(vtkSonoGpuTexture);

vtkSonoGpuTexture::vtkSonoGpuTexture() = default;

vtkSonoGpuTexture::~vtkSonoGpuTexture() = default;

void vtkSonoGpuTexture::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Width: " << this->Width << endl;
  os << indent << "Height: " << this->Height << endl;
}

bool vtkSonoGpuTexture::CanBe()
{
  return sono::cudaStatus().usable;
}

bool vtkSonoGpuTexture::Open(unsigned int name, int width, int height)
{
  this->Texture = nullptr; // before another one is taken, which may be the same
  this->Texture = sono::GreyTexture::of(name, width, height);
  this->Width = width;
  this->Height = height;
  return this->IsOpen();
}

void vtkSonoGpuTexture::Close()
{
  this->Texture = nullptr;
}

bool vtkSonoGpuTexture::Fill(vtkUnsignedCharArray* greys, vtkUnsignedCharArray* colors)
{
  sono::GreyColours table;
  if (!this->Texture || !greys || greys->GetNumberOfComponents() != 1 ||
      greys->GetNumberOfTuples() != vtkIdType(this->Width) * this->Height || !colors ||
      colors->GetNumberOfValues() != vtkIdType(table.size()))
  {
    return false;
  }
  std::copy_n(colors->GetPointer(0), table.size(), table.begin());
  return this->Texture->fill(greys->GetPointer(0), table);
}

bool vtkSonoGpuTexture::Holds(vtkUnsignedCharArray* greys)
{
  return greys && sono::isOnGpu(greys->GetPointer(0));
}

void vtkSonoGpuTexture::KeepPictures()
{
  sono::keepPicturesOnGpu();
}
