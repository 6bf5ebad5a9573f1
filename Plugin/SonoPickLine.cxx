#include "SonoPickLine.h"

#include "SonoFlatView.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoALine.h"

#include <array>
#include <cstring>
#include <string>
#include <utility>

namespace {

using Vector = std::array<double, 3>;

/// A straight line through the scene, at the place of the view that was clicked.
struct Sight
{
  Vector from;
  Vector to;
};

Vector worldFromDisplay(vtkRenderer* renderer, double x, double y, double depth)
{
  renderer->SetDisplayPoint(x, y, depth);
  renderer->DisplayToWorld();
  const double* p = renderer->GetWorldPoint();
  return { p[0] / p[3], p[1] / p[3], p[2] / p[3] };
}

/// The numbers that an output carries in its field data, wherever the data are.
vtkSmartPointer<vtkFieldData> fieldOf(vtkSMSourceProxy* source, unsigned int port)
{
  auto field = vtkSmartPointer<vtkFieldData>::New();
  vtkPVDataSetAttributesInformation* about =
    source->GetDataInformation(port)->GetAttributeInformation(vtkDataObject::FIELD);
  for (int i = 0; i < about->GetNumberOfArrays(); ++i)
  {
    vtkPVArrayInformation* one = about->GetArrayInformation(i);
    if (one->GetDataType() == VTK_DOUBLE && one->GetNumberOfTuples() == 1)
    {
      vtkNew<vtkDoubleArray> array;
      array->SetName(one->GetName());
      array->SetNumberOfComponents(one->GetNumberOfComponents());
      array->SetNumberOfTuples(1);
      for (int c = 0; c < one->GetNumberOfComponents(); ++c)
      {
        array->SetComponent(0, c, one->GetComponentRange(c)[0]);
      }
      field->AddArray(array);
    }
  }
  return field;
}

/// A place's lateral and axial coordinates in mm where the sight meets the image plane, and how far along it is: 0 to 1
/// between the sight's ends, less behind the camera.
struct Meeting
{
  double lateralMm;
  double axialMm;
  double along;
};

bool meetPlane(const Sight& sight, SonoImageKind kind, vtkFieldData* field, Meeting& meeting)
{
  Vector position{};
  Vector axial{ 0.0, 1.0, 0.0 };
  Vector lateral{ 1.0, 0.0, 0.0 };
  if (kind == SonoImageKind::InWorld)
  {
    for (const auto& [name, vector] : { std::pair("ProbePositionMm", &position), std::pair("ProbeAxial", &axial),
                                        std::pair("ProbeLateral", &lateral) })
    {
      vtkDataArray* array = field->GetArray(name);
      if (!array)
      {
        return false;
      }
      array->GetTuple(0, vector->data());
    }
  }
  Vector normal;
  vtkMath::Cross(axial.data(), lateral.data(), normal.data());
  Vector direction;
  vtkMath::Subtract(sight.to.data(), sight.from.data(), direction.data());
  Vector offset;
  vtkMath::Subtract(position.data(), sight.from.data(), offset.data());
  const double across = vtkMath::Dot(direction.data(), normal.data());
  if (across == 0.0)
  {
    return false; // seen edge on
  }
  meeting.along = vtkMath::Dot(offset.data(), normal.data()) / across;
  Vector at;
  for (int i = 0; i < 3; ++i)
  {
    at[i] = meeting.along * direction[i] - offset[i];
  }
  meeting.lateralMm = vtkMath::Dot(at.data(), lateral.data());
  meeting.axialMm = vtkMath::Dot(at.data(), axial.data());
  return true;
}

/// Whether data flow from one source to another along the inputs.
bool comesFrom(vtkSMProxy* source, vtkSMProxy* origin)
{
  while (source && source != origin)
  {
    source = source->GetProperty("Input") ? vtkSMPropertyHelper(source, "Input").GetAsProxy() : nullptr;
  }
  return source != nullptr;
}

/// The A-Line that plots the lines an image was made of.
vtkSMSourceProxy* plotOf(vtkSMSourceProxy* image)
{
  vtkNew<vtkSMProxyIterator> sources;
  sources->SetSessionProxyManager(image->GetSessionProxyManager());
  sources->SetModeToOneGroup();
  for (sources->Begin("sources"); !sources->IsAtEnd(); sources->Next())
  {
    vtkSMProxy* source = sources->GetProxy();
    if (std::strcmp(source->GetXMLName(), "SonoALine") == 0 &&
        comesFrom(image, vtkSMPropertyHelper(source, "Input").GetAsProxy()))
    {
      return vtkSMSourceProxy::SafeDownCast(source);
    }
  }
  return nullptr;
}

} // namespace

SonoPickedLine sonoPickLine(vtkSMRenderViewProxy* view, int x, int y)
{
  const Sight sight{ worldFromDisplay(view->GetRenderer(), x, y, 0.0),
                     worldFromDisplay(view->GetRenderer(), x, y, 1.0) };
  SonoPickedLine picked;
  double nearest = VTK_DOUBLE_MAX;
  const vtkSMPropertyHelper representations(view, "Representations");
  for (unsigned int i = 0; i < representations.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* shown = representations.GetAsProxy(i);
    const vtkSMPropertyHelper input(shown, "Input", true);
    auto* image = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
    if (!image || vtkSMPropertyHelper(shown, "Visibility", true).GetAsInt() != 1)
    {
      continue;
    }
    const SonoImageKind kind = sonoImageKind(image, input.GetOutputPort());
    if (kind == SonoImageKind::None)
    {
      continue;
    }
    const vtkSmartPointer<vtkFieldData> field = fieldOf(image, input.GetOutputPort());
    Meeting meeting;
    if (!meetPlane(sight, kind, field, meeting) || meeting.along < 0.0 || meeting.along > 1.0 ||
        meeting.along >= nearest)
    {
      continue; // edge on, out of sight, or behind another
    }
    const int line = vtkSonoALine::LineAt(field, meeting.lateralMm, meeting.axialMm);
    vtkSMSourceProxy* plot = line >= 0 ? plotOf(image) : nullptr;
    if (plot)
    {
      nearest = meeting.along;
      picked = { plot, line };
    }
  }
  return picked;
}
