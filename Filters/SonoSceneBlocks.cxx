#include "SonoSceneBlocks.h"

#include "Scene/CoarseSurface.h"
#include "Scene/Scene.h"
#include "SonoLabelImage.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>

namespace sono {
namespace {

/// Edge of the cubes in which points become one. A sixth of the triangles is left, and 99.8 % of the bundled thorax's
/// surfaces stay within half a voxel of where they are, at 1 mm.
constexpr double cubeVoxels = 2.5;

void addBlock(vtkPolyData* surface, const std::string& name, vtkMultiBlockDataSet* blocks)
{
  const unsigned int index = blocks->GetNumberOfBlocks();
  blocks->SetBlock(index, surface);
  blocks->GetMetaData(index)->Set(vtkCompositeDataSet::NAME(), name);
}

vtkSmartPointer<vtkPolyData> polyData(const DrawnSurface& surface, const std::array<float, 3>& color)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(surface.points.size()));
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(points->GetNumberOfPoints());
  for (std::size_t i = 0; i < surface.points.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), surface.points[i].data());
    normals->SetTypedTuple(static_cast<vtkIdType>(i), surface.normals[i].data());
  }
  vtkNew<vtkCellArray> triangles;
  // Millions of them: half of VTK's own 64 bits a number, and no room to grow.
  triangles->Use32BitStorage();
  const auto count = static_cast<vtkIdType>(surface.triangles.size());
  triangles->AllocateExact(count, 3 * count);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("Color");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(count);
  for (int c = 0; c < 3; ++c)
  {
    colors->FillComponent(c, std::round(255.0 * color[c]));
  }
  for (const std::array<int, 3>& triangle : surface.triangles)
  {
    triangles->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  result->SetPolys(triangles);
  result->GetPointData()->SetNormals(normals);
  result->GetCellData()->AddArray(colors);
  return result;
}

} // namespace

void addLabelSurfaces(const Scene& scene, vtkMultiBlockDataSet* blocks, const Progress& progress)
{
  const std::vector<LabelInfo>& labels = scene.volume().labels;
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    const Progress part = partOf(progress, double(i) / labels.size(), double(i + 1) / labels.size());
    report(part, 0.0);
    if (labels[i].id != 0)
    {
      // The skin of a large body takes seconds: each of its steps is told.
      const SurfaceField& field = scene.surface(labels[i].id, partOf(part, 0.0, 0.5));
      const auto fine = meshSurface(scene.volume(), field);
      report(part, 0.7);
      const DrawnSurface drawn = coarseSurface(fine, cubeVoxels * field.smoothingMm);
      report(part, 0.9);
      addBlock(polyData(drawn, displayColor(labels[i])), labels[i].name, blocks);
    }
  }
}

void addOutline(const Scene& scene, vtkMultiBlockDataSet* blocks)
{
  const GridPlacement& grid = scene.placement();
  const Vec3d first(-0.5); // the box ends at the outer faces of the voxels
  const Vec3d last = Vec3d(grid.size) - 0.5;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> edges;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec3d index(corner & 1 ? last.x : first.x, corner & 2 ? last.y : first.y, corner & 4 ? last.z : first.z);
    const Vec3d world = grid.worldFromIndex(index);
    points->InsertNextPoint(&world.x);
    for (int axis = 1; axis < 8; axis *= 2)
    {
      if (!(corner & axis))
      {
        edges->InsertNextCell({ corner, corner | axis });
      }
    }
  }
  vtkNew<vtkPolyData> outline;
  outline->SetPoints(points);
  outline->SetLines(edges);
  addBlock(outline, "Outline", blocks);
}

} // namespace sono
