#include "vtkSonoPictureWriter.h"

#include "Core/Progress.h"
#include "SonoPicture.h"
#include "SonoStage.h"

#include "vtkDataSetAttributes.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoPictureWriter);

vtkSonoPictureWriter::vtkSonoPictureWriter()
{
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                               vtkDataSetAttributes::AttributeTypes::SCALARS);
}

vtkSonoPictureWriter::~vtkSonoPictureWriter() = default;

void vtkSonoPictureWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
}

int vtkSonoPictureWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

void vtkSonoPictureWriter::WriteData()
{
  bool isWritten = false;
  sono::runWork(this, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No picture file is named; set FileName to one that ends in .png, .tif or .exr.");
    }
    auto* image = vtkImageData::SafeDownCast(this->GetInput());
    vtkDataArray* array = this->GetInputArrayToProcess(0, image);
    if (!array)
    {
      throw sono::Error("The image has no such point array to write; choose one that it has.");
    }
    sono::writePicture(this->FileName, sono::pictureOf(image, array));
    isWritten = true;
  });
  this->SetErrorCode(isWritten ? vtkErrorCode::NoError : vtkErrorCode::CannotOpenFileError);
}
