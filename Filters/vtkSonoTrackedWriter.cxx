#include "vtkSonoTrackedWriter.h"

#include "Core/Error.h"
#include "Files/TrackedCine.h"
#include "SonoGreyImage.h"
#include "SonoPoses.h"
#include "SonoProbeField.h"

#include "vtkImageData.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoTrackedWriter);

vtkSonoTrackedWriter::vtkSonoTrackedWriter()
{
  this->SetProgressText("Writing a tracked sequence");
}

vtkSonoTrackedWriter::~vtkSonoTrackedWriter() = default;

std::string vtkSonoTrackedWriter::NamelessRefusal() const
{
  return "No file is named; set FileName to one that ends in .igs.mha or .igs.nrrd.";
}

void vtkSonoTrackedWriter::Open(vtkImageData* image)
{
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
  info.timesS = this->TimesS(std::size_t(greys.count()));
  info.poses = sono::picturePoses(image->GetFieldData(), probe.pose, info.timesS.size());
  this->Cine = std::make_unique<sono::TrackedCine>(this->GetFileName(), info);
}

void vtkSonoTrackedWriter::AddStep(vtkImageData* image)
{
  const sono::GreySlices slices(image);
  for (int n = 0; n < slices.count(); ++n)
  {
    this->Cine->add(slices.at(n), slices.width(), slices.height());
    this->Tell(double(n + 1) / slices.count());
  }
}

void vtkSonoTrackedWriter::Finish()
{
  this->Cine->finish();
}

void vtkSonoTrackedWriter::Close()
{
  this->Cine.reset();
}
