#include "SonoContent.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

namespace sono {
namespace {

void appendTimes(vtkFieldData* arrays, std::vector<double>& content)
{
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    content.push_back(static_cast<double>(arrays->GetAbstractArray(i)->GetMTime()));
  }
}

} // namespace

std::vector<double> contentOf(vtkDataObject* input)
{
  std::vector<double> content;
  appendTimes(input->GetFieldData(), content);
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    appendTimes(image->GetPointData(), content);
    content.insert(content.end(), image->GetExtent(), image->GetExtent() + 6);
    content.insert(content.end(), image->GetOrigin(), image->GetOrigin() + 3);
    content.insert(content.end(), image->GetSpacing(), image->GetSpacing() + 3);
    const double* direction = image->GetDirectionMatrix()->GetData();
    content.insert(content.end(), direction, direction + 9);
  }
  if (auto* points = vtkPointSet::SafeDownCast(input))
  {
    appendTimes(points->GetPointData(), content);
    appendTimes(points->GetCellData(), content);
    content.push_back(points->GetPoints() ? static_cast<double>(points->GetPoints()->GetMTime()) : 0.0);
  }
  if (auto* surface = vtkPolyData::SafeDownCast(input))
  {
    content.push_back(static_cast<double>(surface->GetMeshMTime()));
  }
  return content;
}

} // namespace sono
