#include "SonoGreyImage.h"

#include "Core/Error.h"
#include "Image/ScanConvert.h"

#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

namespace sono {

GreySlices::GreySlices(vtkImageData* image)
{
  auto* greys = vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray("BMode"));
  if (!greys || greys->GetNumberOfComponents() != 1)
  {
    throw Error("The image has no point array 'BMode' of unsigned char; connect an image of Simulate Ultrasound, Scan "
                "Conversion or Ultrasound Sweep.");
  }
  image->GetDimensions(size_.data());
  first_ = greys->GetPointer(0);
}

LabelSlices::LabelSlices(vtkImageData* image)
{
  auto* labels = vtkUnsignedShortArray::SafeDownCast(image->GetPointData()->GetArray("Labels"));
  if (!labels || labels->GetNumberOfComponents() != 1)
  {
    throw Error(
      "The image has no point array 'Labels'; switch the labels on where the image is made, or the label masks "
      "off.");
  }
  image->GetDimensions(size_.data());
  first_ = labels->GetPointer(0);
}

GreyLayout greyLayout(vtkImageData* image, const ScanGeometry& geometry)
{
  const GreySlices slices(image);
  GreyLayout layout{ slices.width(), slices.height(), image->GetSpacing()[0], {} };
  if (!geometry.isVolume())
  {
    const PlaneImage plane = planeImageLayout(geometry, layout.pixelMm);
    if (plane.width != layout.width || plane.height != layout.height)
    {
      throw Error("The image is " + std::to_string(layout.width) + " x " + std::to_string(layout.height) +
                  " pixels and its probe scans " + std::to_string(plane.width) + " x " + std::to_string(plane.height) +
                  "; connect the whole image, not cut or resampled.");
    }
    layout.firstMm = { plane.lateralMinMm, plane.axialMinMm };
  }
  return layout;
}

} // namespace sono
