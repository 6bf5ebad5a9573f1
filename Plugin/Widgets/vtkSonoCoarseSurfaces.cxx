#include "vtkSonoCoarseSurfaces.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkQuadricClustering.h"

#include <algorithm>
#include <utility>

vtkStandardNewMacro(vtkSonoCoarseSurfaces);

namespace {

/// Points and triangles alone.
vtkSmartPointer<vtkPolyData> coarse(vtkPoints* points, vtkCellArray* polygons, double cubeMm)
{
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(points);
  bare->SetPolys(polygons);
  vtkNew<vtkQuadricClustering> clustering;
  clustering->SetInputData(bare);
  clustering->SetDivisionOrigin(0.0, 0.0, 0.0);
  clustering->SetDivisionSpacing(cubeMm, cubeMm, cubeMm);
  clustering->Update();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(clustering->GetOutput()->GetPoints());
  result->SetPolys(clustering->GetOutput()->GetPolys());
  result->GetPolys()->ConvertTo32BitStorage(); // half as much to send
  return result;
}

} // namespace

void vtkSonoCoarseSurfaces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CubeMm: " << this->CubeMm << endl;
  os << indent << "Version: " << this->Version << endl;
}

int vtkSonoCoarseSurfaces::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite one first: the pipeline would otherwise hand it over block by block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

bool vtkSonoCoarseSurfaces::IsMadeOf(const std::vector<Shape>& shapes) const
{
  const auto isSame = [](const Shape& a, const Shape& b) {
    return a.points == b.points && a.polygons == b.polygons && a.time == b.time;
  };
  return this->Version > 0 && this->CubeMm == this->MadeCubeMm &&
         std::equal(shapes.begin(), shapes.end(), this->Made.begin(), this->Made.end(), isSame);
}

int vtkSonoCoarseSurfaces::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  std::vector<Shape> shapes;
  const auto add = [&](vtkDataObject* data) {
    vtkPolyData* mesh = vtkPolyData::SafeDownCast(data);
    if (mesh && mesh->GetNumberOfPolys() > 0)
    {
      shapes.push_back(
        { mesh->GetPoints(), mesh->GetPolys(), std::max(mesh->GetPoints()->GetMTime(), mesh->GetPolys()->GetMTime()) });
    }
  };
  vtkDataObject* data = vtkDataObject::GetData(input[0]);
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    const auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      add(leaf->GetCurrentDataObject());
    }
  }
  else
  {
    add(data);
  }
  if (!this->IsMadeOf(shapes))
  {
    this->Kept->Initialize();
    for (const Shape& shape : shapes)
    {
      this->Kept->SetBlock(this->Kept->GetNumberOfBlocks(), coarse(shape.points, shape.polygons, this->CubeMm));
    }
    this->Made = std::move(shapes);
    this->MadeCubeMm = this->CubeMm;
    ++this->Version;
  }
  vtkMultiBlockDataSet::GetData(output)->ShallowCopy(this->Kept);
  return 1;
}
