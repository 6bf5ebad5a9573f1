#include "vtkSonoCoarseSurfaces.h"

#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkQuadricClustering.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkSonoCoarseSurfaces);

namespace {

/// Points and triangles alone.
vtkSmartPointer<vtkPolyData> coarse(vtkPolyData* mesh, double cubeMm)
{
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(mesh->GetPoints());
  bare->SetPolys(mesh->GetPolys());
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
}

int vtkSonoCoarseSurfaces::FillInputPortInformation(int, vtkInformation* info)
{
  // The composite one first: the pipeline would otherwise hand it over block by block.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkSonoCoarseSurfaces::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(output);
  const auto add = [&](vtkDataObject* data) {
    vtkPolyData* mesh = vtkPolyData::SafeDownCast(data);
    if (mesh && mesh->GetNumberOfPolys() > 0)
    {
      blocks->SetBlock(blocks->GetNumberOfBlocks(), coarse(mesh, this->CubeMm));
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
  return 1;
}
