#include "vtkSonoTrackedWriter.h"

#include "Core/Progress.h"
#include "Files/TrackedCine.h"
#include "SonoGreyImage.h"
#include "SonoPoses.h"
#include "SonoProbeField.h"
#include "SonoTimeSteps.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoTrackedWriter);

vtkSonoTrackedWriter::vtkSonoTrackedWriter()
  : Steps(new sono::TimeSteps)
{
  this->SetProgressText("Writing a tracked sequence");
}

vtkSonoTrackedWriter::~vtkSonoTrackedWriter() = default;

void vtkSonoTrackedWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "FrameTimeMs: " << this->FrameTimeMs << endl;
}

int vtkSonoTrackedWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

vtkTypeBool vtkSonoTrackedWriter::ProcessRequest(vtkInformation* request, vtkInformationVector** input,
                                                 vtkInformationVector* output)
{
  const sono::StepWork work{ [this](vtkImageData* image) { this->Begin(image); },
                             [this](vtkImageData* image) { this->AddFrames(image); }, [this] { this->Cine->finish(); },
                             [this](bool isWritten) {
                               this->Cine.reset();
                               this->SetErrorCode(isWritten ? vtkErrorCode::NoError
                                                            : vtkErrorCode::CannotOpenFileError);
                             } };
  return this->Steps->process(this, this->FileName, work, request, input)
           ? 1
           : this->Superclass::ProcessRequest(request, input, output);
}

void vtkSonoTrackedWriter::Begin(vtkImageData* image)
{
  if (this->FileName.empty())
  {
    throw sono::Error("No file is named; set FileName to one that ends in .igs.mha or .igs.nrrd.");
  }
  const sono::GreySlices greys(image); // the first that may be missing
  const sono::ProbeField probe = sono::readProbe(image->GetFieldData());
  if (probe.geometry.isVolume())
  {
    throw sono::Error("The probe scans a volume, and a tracked sequence holds pictures of a plane; choose another scan "
                      "kind.");
  }
  const sono::GreyLayout layout = sono::greyLayout(image, probe.geometry);
  sono::TrackedInfo info;
  info.width = layout.width;
  info.height = layout.height;
  info.pixelMm = { layout.pixelMm, layout.pixelMm };
  info.firstMm = layout.firstMm;
  info.timesS = sono::frameTimesS(*this->Steps, std::size_t(greys.count()), this->FrameTimeMs);
  info.poses = sono::readPoses(image->GetFieldData());
  if (info.poses.empty())
  {
    info.poses.assign(info.timesS.size(), probe.pose);
  }
  this->Cine = std::make_unique<sono::TrackedCine>(this->FileName, info);
}

void vtkSonoTrackedWriter::AddFrames(vtkImageData* image)
{
  const sono::GreySlices slices(image);
  for (int n = 0; n < slices.count(); ++n)
  {
    this->Cine->add(slices.at(n), slices.width(), slices.height());
    this->Steps->tell(this, double(n + 1) / slices.count());
  }
}
