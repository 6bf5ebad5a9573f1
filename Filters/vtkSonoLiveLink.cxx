#include "vtkSonoLiveLink.h"

#include "Core/Error.h"
#include "Core/Parameters.h"
#include "Core/Require.h"
#include "Link/LiveLink.h"
#include "SonoGreyImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <algorithm>

vtkStandardNewMacro(vtkSonoLiveLink);

namespace {

sono::LinkPicture pictureOf(vtkImageData* image)
{
  const sono::GreySlices greys(image);
  const sono::ProbeField probe = sono::readProbe(image->GetFieldData());
  if (greys.count() != 1 || probe.geometry.isVolume())
  {
    throw sono::Error("The image has " + std::to_string(greys.count()) +
                      " slices and a live link shows one; connect the Flat Image of Simulate Ultrasound or of Scan "
                      "Conversion.");
  }
  const sono::GreyLayout layout = sono::greyLayout(image, probe.geometry);
  sono::LinkPicture picture;
  picture.width = layout.width;
  picture.height = layout.height;
  picture.pixelMm = layout.pixelMm;
  picture.firstMm = layout.firstMm;
  picture.pose = probe.pose;
  picture.grey.assign(greys.at(0), greys.at(0) + std::ptrdiff_t(layout.width) * layout.height);
  return picture;
}

} // namespace

vtkSonoLiveLink::vtkSonoLiveLink()
{
  this->SetProgressText("Sending the image");
}

vtkSonoLiveLink::~vtkSonoLiveLink() = default;

void vtkSonoLiveLink::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Active: " << this->Active << endl;
  os << indent << "Port: " << this->Port << endl;
  os << indent << "OtherComputers: " << this->OtherComputers << endl;
  os << indent << "Transform: " << this->Transform << endl;
  os << indent << "Status: " << this->GetStatus() << endl;
}

int vtkSonoLiveLink::GetOpenPort() const
{
  return this->Link ? this->Link->port() : 0;
}

const char* vtkSonoLiveLink::GetStatus()
{
  if (!this->Link)
  {
    this->Status = "Nobody can connect.";
    return this->Status.c_str();
  }
  const sono::LinkState state = this->Link->state();
  this->Status = "Port " + std::to_string(this->Link->port()) + ", " + std::to_string(state.clients) +
                 (state.clients == 1 ? " client, " : " clients, ") + std::to_string(state.poseCount) +
                 (state.poseCount == 1 ? " pose" : " poses") + " received." +
                 (state.notice.empty() ? "" : " " + state.notice);
  return this->Status.c_str();
}

int vtkSonoLiveLink::GetReceivedCount() const
{
  return this->Link ? int(this->Link->state().poseCount) : 0;
}

double* vtkSonoLiveLink::GetReceivedPose()
{
  if (this->GetReceivedCount() > 0)
  {
    const sono::ProbePose pose = this->Link->state().pose;
    double* to = this->ReceivedPose;
    for (const sono::Vec3d& part : { pose.positionMm, pose.axial, pose.lateral })
    {
      to = std::copy_n(&part.x, 3, to);
    }
  }
  return this->ReceivedPose;
}

int vtkSonoLiveLink::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

void vtkSonoLiveLink::Open()
{
  constexpr std::size_t longestName = 20; // of OpenIGTLink
  sono::requireInRange(this->Port >= 0 && this->Port <= 65535, "Port", this->Port, "between 0 and 65535");
  if (this->Transform.empty() || this->Transform.size() > longestName)
  {
    throw sono::Error("Transform is '" + this->Transform + "'; give it a name of up to 20 characters.");
  }
  const std::string settings =
    std::to_string(this->Port) + (this->OtherComputers ? " open " : " closed ") + this->Transform;
  if (this->Link && this->Opened == settings)
  {
    return;
  }
  this->Link.reset(); // its port may be the same
  this->Link = std::make_unique<sono::LiveLink>(this->Port, this->OtherComputers, this->Transform);
  this->Opened = settings;
}

int vtkSonoLiveLink::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* image = vtkImageData::GetData(input[0]);
    vtkImageData::GetData(output)->ShallowCopy(image);
    if (!this->Active)
    {
      this->Link.reset();
      return;
    }
    const sono::LinkPicture picture = pictureOf(image);
    this->Open();
    this->Link->show(picture);
  });
}
