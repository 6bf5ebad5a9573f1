#include "vtkSonoLineWriter.h"

#include "Core/Progress.h"
#include "Files/LineCine.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoTimeSteps.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

vtkStandardNewMacro(vtkSonoLineWriter);

vtkSonoLineWriter::vtkSonoLineWriter()
  : Steps(new sono::TimeSteps)
{
  this->SetProgressText("Writing lines");
}

vtkSonoLineWriter::~vtkSonoLineWriter() = default;

void vtkSonoLineWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "FrameTimeMs: " << this->FrameTimeMs << endl;
}

int vtkSonoLineWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

vtkTypeBool vtkSonoLineWriter::ProcessRequest(vtkInformation* request, vtkInformationVector** input,
                                              vtkInformationVector* output)
{
  const sono::StepWork work{ [this](vtkImageData* lines) { this->Begin(lines); },
                             [this](vtkImageData* lines) { this->AddFrame(lines); }, [this] { this->Cine->finish(); },
                             [this](bool isWritten) {
                               this->Cine.reset();
                               this->SetErrorCode(isWritten ? vtkErrorCode::NoError
                                                            : vtkErrorCode::CannotOpenFileError);
                             } };
  return this->Steps->process(this, this->FileName, work, request, input)
           ? 1
           : this->Superclass::ProcessRequest(request, input, output);
}

void vtkSonoLineWriter::Begin(vtkImageData* lines)
{
  if (this->FileName.empty())
  {
    throw sono::Error("No file is named; set FileName to one that ends in .hdf5 or .uff.");
  }
  const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
  const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
  sono::LineCineInfo info;
  info.probe = probe;
  info.pose = probe.pose;
  info.sampleCount = layout.sampleCount;
  info.sampleMm = layout.sampleMm;
  info.samplingMHz = sono::readNumber("SamplingMHz", lines->GetFieldData());
  info.demodulationMHz = probe.receivedMHz();
  info.timesS = sono::frameTimesS(*this->Steps, 1, this->FrameTimeMs);
  sono::complexLineValues("IQ", lines->GetPointData()); // says what is missing before there is a file
  this->Cine = sono::lineFile(this->FileName, info);
}

void vtkSonoLineWriter::AddFrame(vtkImageData* lines)
{
  this->Cine->add(sono::complexLineValues("IQ", lines->GetPointData()));
  this->Steps->tell(this, 1.0);
}
