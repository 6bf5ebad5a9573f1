#include "SonoScatterers.h"

#include "Core/Error.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"

#include <vector>

namespace sono {

std::shared_ptr<const PointScatterers> pointScatterers(vtkPointSet* points)
{
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return nullptr;
  }
  vtkDataArray* amplitude = points->GetPointData()->GetArray("Amplitude");
  if (!amplitude || amplitude->GetNumberOfComponents() != 1)
  {
    throw Error("The scatterers have no point array 'Amplitude' with one component; add it, for example with a "
                "Calculator.");
  }
  std::vector<PointScatterer> scatterers(static_cast<std::size_t>(points->GetNumberOfPoints()));
  for (std::size_t i = 0; i < scatterers.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    points->GetPoint(id, &scatterers[i].positionMm.x);
    scatterers[i].amplitude = static_cast<float>(amplitude->GetTuple1(id));
  }
  return std::make_shared<const PointScatterers>(scatterers);
}

} // namespace sono
