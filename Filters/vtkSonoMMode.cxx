#include "vtkSonoMMode.h"

#include "Core/Progress.h"
#include "Image/GreyBytes.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <string>

vtkStandardNewMacro(vtkSonoMMode);

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr int mostColumns = 100000;

/// Equidistant times, each with the step that it shows.
struct TimeAxis
{
  double firstS;
  double stepS;
  std::vector<std::size_t> shown;
};

TimeAxis timeAxis(const std::vector<double>& times, double secondsPerStep)
{
  TimeAxis axis{ times.front(), secondsPerStep, {} };
  if (secondsPerStep > 0.0)
  {
    for (std::size_t i = 0; i < times.size(); ++i)
    {
      axis.shown.push_back(i);
    }
    axis.firstS = 0.0;
    return axis;
  }
  axis.stepS = times[1] - times[0];
  for (std::size_t i = 1; i < times.size(); ++i)
  {
    axis.stepS = std::min(axis.stepS, times[i] - times[i - 1]);
  }
  const double last = std::round((times.back() - times.front()) / axis.stepS);
  if (!(last < mostColumns))
  {
    throw sono::Error("Two time steps of the input are too close beside the others for an image of equidistant times; "
                      "set SecondsPerStep.");
  }
  for (int column = 0; column <= int(last); ++column)
  {
    const double time = times.front() + (column + 1e-6) * axis.stepS;
    axis.shown.push_back(std::size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin()) - 1);
  }
  return axis;
}

} // namespace

vtkSonoMMode::vtkSonoMMode()
{
  this->SetProgressText("Following the line");
}

vtkSonoMMode::~vtkSonoMMode() = default;

void vtkSonoMMode::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Line: " << this->Line << endl;
  os << indent << "SecondsPerStep: " << this->SecondsPerStep << endl;
}

int vtkSonoMMode::RequestInformation(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::announceStage(this, [&] {
    this->Columns.clear();
    if (this->Line < 0)
    {
      throw sono::Error("Line is " + std::to_string(this->Line) + " but must be at least 0.");
    }
    if (!(this->SecondsPerStep >= 0.0) || !std::isfinite(this->SecondsPerStep))
    {
      throw sono::Error("SecondsPerStep is " + std::to_string(this->SecondsPerStep) +
                        " but must be at least 0 and finite, in s.");
    }
    vtkInformation* inInfo = input[0]->GetInformationObject(0);
    const int count = inInfo->Has(Pipeline::TIME_STEPS()) ? inInfo->Length(Pipeline::TIME_STEPS()) : 0;
    if (count < 2)
    {
      throw sono::Error("The input has no time steps, and M-mode shows a line over time; open several label maps as "
                        "phases, or a 4-D NIfTI file.");
    }
    const double* times = inInfo->Get(Pipeline::TIME_STEPS());
    this->StepTimes.assign(times, times + count);
    const TimeAxis axis = timeAxis(this->StepTimes, this->SecondsPerStep);

    int lines[6];
    inInfo->Get(Pipeline::WHOLE_EXTENT(), lines);
    const double* lineOrigin = inInfo->Get(vtkDataObject::ORIGIN());
    const double* lineSpacing = inInfo->Get(vtkDataObject::SPACING());
    const int extent[6] = { 0, static_cast<int>(axis.shown.size()) - 1, 0, lines[1] - lines[0], 0, 0 };
    const double origin[3] = { axis.firstS, lineOrigin[0], 0.0 };
    const double spacing[3] = { axis.stepS, lineSpacing[0], 1.0 };
    vtkInformation* outInfo = output->GetInformationObject(0);
    outInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
    outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
    outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
    outInfo->Remove(Pipeline::TIME_STEPS());
    outInfo->Remove(Pipeline::TIME_RANGE());
    vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VTK_UNSIGNED_CHAR, 1);
  });
}

int vtkSonoMMode::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  if (this->Columns.size() < this->StepTimes.size())
  {
    input[0]->GetInformationObject(0)->Set(Pipeline::UPDATE_TIME_STEP(), this->StepTimes[this->Columns.size()]);
  }
  return sono::requestWholeImage(input);
}

void vtkSonoMMode::TakeLine(vtkImageData* lines)
{
  const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
  const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
  const std::vector<float> grey =
    sono::lineValues("BMode", lines->GetPointData(), std::size_t(layout.lineCount) * layout.sampleCount);
  const auto first = grey.begin() + std::ptrdiff_t(std::min(this->Line, layout.lineCount - 1)) * layout.sampleCount;
  this->Columns.emplace_back(first, first + layout.sampleCount);
}

void vtkSonoMMode::MakeImage(const std::vector<std::size_t>& shownSteps, vtkImageData* image)
{
  const std::size_t width = shownSteps.size();
  const std::size_t height = this->Columns.front().size();
  std::vector<float> grey(width * height);
  for (std::size_t x = 0; x < width; ++x)
  {
    const std::vector<float>& column = this->Columns[shownSteps[x]];
    for (std::size_t y = 0; y < height; ++y)
    {
      grey[y * width + x] = column[y];
    }
  }
  const std::vector<std::uint8_t> bytes = sono::greyBytes(grey, std::vector<std::uint8_t>(grey.size(), 1));
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName("BMode");
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  image->GetPointData()->SetScalars(array);
}

int vtkSonoMMode::RequestData(vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  const int result = sono::runStage(this, output, [&] {
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    this->TakeLine(lines);
    if (this->Columns.size() < this->StepTimes.size())
    {
      this->UpdateProgress(double(this->Columns.size()) / double(this->StepTimes.size()));
      request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
      return;
    }
    vtkImageData* image = vtkImageData::GetData(output);
    const double sampleMm = lines->GetSpacing()[0];
    const TimeAxis axis = timeAxis(this->StepTimes, this->SecondsPerStep);
    image->SetDimensions(static_cast<int>(axis.shown.size()), static_cast<int>(this->Columns.front().size()), 1);
    image->SetOrigin(axis.firstS, lines->GetOrigin()[0], 0.0);
    image->SetSpacing(axis.stepS, sampleMm, 1.0);
    this->MakeImage(axis.shown, image);
    image->GetInformation()->Remove(vtkDataObject::DATA_TIME_STEP());
  });
  if (!request->Has(Pipeline::CONTINUE_EXECUTING())) // done, failed or stopped
  {
    this->Columns.clear();
  }
  return result;
}
