#include "vtkSonoFrameWriter.h"

#include "Core/Error.h"
#include "SonoTimeSteps.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"

vtkSonoFrameWriter::vtkSonoFrameWriter()
  : Steps(new sono::TimeSteps)
{
}

vtkSonoFrameWriter::~vtkSonoFrameWriter() = default;

void vtkSonoFrameWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "FrameTimeMs: " << this->FrameTimeMs << endl;
}

int vtkSonoFrameWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

vtkTypeBool vtkSonoFrameWriter::ProcessRequest(vtkInformation* request, vtkInformationVector** input,
                                               vtkInformationVector* output)
{
  const auto open = [this](vtkImageData* image) {
    if (this->FileName.empty())
    {
      throw sono::Error(this->NamelessRefusal());
    }
    this->Open(image);
  };
  const auto end = [this](bool isWritten) {
    this->Close();
    this->SetErrorCode(isWritten ? vtkErrorCode::NoError : vtkErrorCode::CannotOpenFileError);
  };
  const sono::StepWork work{ open, [this](vtkImageData* image) { this->AddStep(image); }, [this] { this->Finish(); },
                             end };
  return this->Steps->process(this, this->FileName, work, request, input)
           ? 1
           : this->Superclass::ProcessRequest(request, input, output);
}

std::vector<double> vtkSonoFrameWriter::TimesS(std::size_t slices) const
{
  return sono::frameTimesS(*this->Steps, slices, this->FrameTimeMs);
}

void vtkSonoFrameWriter::Tell(double fraction)
{
  this->Steps->tell(this, fraction);
}
