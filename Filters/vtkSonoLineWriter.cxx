#include "vtkSonoLineWriter.h"

#include "Core/Error.h"
#include "Files/ChannelCine.h"
#include "Files/LineCine.h"
#include "SonoChannelImage.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"

#include "vtkImageData.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

vtkStandardNewMacro(vtkSonoLineWriter);

vtkSonoLineWriter::vtkSonoLineWriter()
{
  this->SetProgressText("Writing lines");
}

vtkSonoLineWriter::~vtkSonoLineWriter() = default;

std::string vtkSonoLineWriter::NamelessRefusal() const
{
  return "No file is named; set FileName to one that ends in .hdf5 or .uff.";
}

void vtkSonoLineWriter::Open(vtkImageData* image)
{
  sono::holdsChannels(image) ? this->OpenChannels(image) : this->OpenLines(image);
}

void vtkSonoLineWriter::OpenChannels(vtkImageData* channels)
{
  const sono::ProbeField probe = sono::readProbe(channels->GetFieldData());
  const sono::ChannelLayout layout = sono::channelLayout(channels);
  sono::ChannelCineInfo info;
  info.probe = probe;
  info.pose = probe.pose;
  info.elements = layout.elements;
  info.transmits = layout.transmits;
  info.sampleCount = layout.sampleCount;
  info.samplingMHz = layout.samplingMHz;
  info.timesS = this->TimesS(1);
  sono::lineValues("RF", channels->GetPointData(), info.valueCount());
  this->Channels = sono::channelFile(this->GetFileName(), info);
}

void vtkSonoLineWriter::OpenLines(vtkImageData* lines)
{
  const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
  const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
  sono::LineCineInfo info;
  info.probe = probe;
  info.pose = probe.pose;
  info.sampleCount = layout.sampleCount;
  info.sampleMm = layout.sampleMm;
  info.samplingMHz = sono::readNumber("SamplingMHz", lines->GetFieldData());
  info.demodulationMHz = probe.receivedMHz();
  info.timesS = this->TimesS(1);
  sono::complexLineValues("IQ", lines->GetPointData()); // says what is missing before there is a file
  this->Cine = sono::lineFile(this->GetFileName(), info);
}

void vtkSonoLineWriter::AddStep(vtkImageData* image)
{
  if (this->Channels)
  {
    this->Channels->add(sono::lineValues("RF", image->GetPointData(), std::size_t(image->GetNumberOfPoints())));
  }
  else
  {
    this->Cine->add(sono::complexLineValues("IQ", image->GetPointData()));
  }
  this->Tell(1.0);
}

void vtkSonoLineWriter::Finish()
{
  this->Channels ? this->Channels->finish() : this->Cine->finish();
}

void vtkSonoLineWriter::Close()
{
  this->Cine.reset();
  this->Channels.reset();
}
