#include "vtkSonoALine.h"

#include "Core/Progress.h"
#include "SonoImagePlacement.h"
#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

vtkStandardNewMacro(vtkSonoALine);

namespace {

void addColumn(const char* name, int rows, const std::function<double(int)>& value, vtkTable* table)
{
  vtkNew<vtkDoubleArray> column;
  column->SetName(name);
  column->SetNumberOfValues(rows);
  for (int row = 0; row < rows; ++row)
  {
    column->SetValue(row, value(row));
  }
  table->AddColumn(column);
}

void drawLine(int line, const sono::Vec3d& from, const sono::Vec3d& to, vtkPolyData* polyData)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ points->InsertNextPoint(&from.x), points->InsertNextPoint(&to.x) });
  polyData->SetPoints(points);
  polyData->SetLines(cells);
  polyData->GetFieldData()->Initialize(); // for the input's, which VTK passes on, nothing that draws a line has a use
  sono::writeNumber("Line", line, polyData->GetFieldData());
}

/// A place in the world as it is drawn on the flat image, also of lines beside its plane.
sono::Vec3d drawnFlat(const sono::Vec3d& worldMm, const sono::ProbeField& probe)
{
  const sono::Vec3d flat = sono::flatFromWorld(worldMm, probe.pose);
  return { flat.x, flat.y, sono::flatDrawingMm };
}

} // namespace

vtkSonoALine::vtkSonoALine()
{
  this->SetNumberOfOutputPorts(3);
}

vtkSonoALine::~vtkSonoALine() = default;

void vtkSonoALine::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Line: " << this->Line << endl;
}

int vtkSonoALine::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoALine::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkTable" : "vtkPolyData");
  return 1;
}

int vtkSonoALine::LineAt(vtkFieldData* field, double lateralMm, double axialMm)
{
  try
  {
    const sono::ProbeField probe = sono::readProbe(field);
    const sono::ScanGeometry& geometry = probe.geometry;
    if (geometry.isVolume())
    {
      return -1;
    }
    const float line = sono::beamFromPlane(geometry, lateralMm, axialMm).x;
    const int inFan = std::isnan(line) ? -1 : static_cast<int>(std::lround(line)) % geometry.lineCount;
    return inFan < 0 ? -1 : (geometry.lineCount * (geometry.fanCount() / 2) + inFan) * probe.linesApart;
  }
  catch (const sono::Error&)
  {
    return -1;
  }
}

int vtkSonoALine::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoALine::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (this->Line < 0)
    {
      throw sono::Error("Line is " + std::to_string(this->Line) + " but must be at least 0.");
    }
    vtkImageData* lines = vtkImageData::GetData(input[0]);
    const sono::ProbeField probe = sono::readProbe(lines->GetFieldData());
    const sono::LineImageLayout layout = sono::lineImageLayout(lines, probe.geometry.totalLineCount());
    const int rows = layout.sampleCount;
    const int line = std::min(this->Line / probe.linesApart, layout.lineCount - 1);
    const vtkIdType first = vtkIdType(line) * rows;

    vtkTable* table = vtkTable::GetData(output);
    addColumn(
      "Depth (mm)", rows, [&](int row) { return layout.firstMm + row * layout.sampleMm; }, table);
    vtkPointData* arrays = lines->GetPointData();
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = arrays->GetArray(i);
      if (array && array->GetNumberOfComponents() == 1)
      {
        addColumn(
          array->GetName(), rows, [&](int row) { return array->GetTuple1(first + row); }, table);
      }
    }
    if (vtkDataArray* envelope = arrays->GetArray("Envelope"))
    {
      const double largest = envelope->GetRange()[1];
      addColumn(
        "Envelope (dB)", rows,
        [&](int row) {
          const double part = largest > 0.0 ? envelope->GetTuple1(first + row) / largest : 0.0;
          return 20.0 * std::log10(std::max(part, 1e-10));
        },
        table);
    }

    const sono::ScanLine place = sono::makeScanLines(probe.geometry, probe.pose)[std::size_t(line)];
    const int shown = line * probe.linesApart;
    const sono::Vec3d end = place.originMm + probe.geometry.depthMm * place.axis;
    drawLine(shown, drawnFlat(place.originMm, probe), drawnFlat(end, probe), vtkPolyData::GetData(output, 1));
    drawLine(shown, place.originMm, end, vtkPolyData::GetData(output, 2));
  });
}
