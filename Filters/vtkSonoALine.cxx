#include "vtkSonoALine.h"

#include "SonoLineImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
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

} // namespace

vtkSonoALine::vtkSonoALine() = default;
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
    const vtkIdType first = vtkIdType(std::min(this->Line, layout.lineCount - 1)) * rows;

    vtkTable* table = vtkTable::GetData(output);
    addColumn(
      "Depth (cm)", rows, [&](int row) { return (layout.firstMm + row * layout.sampleMm) / 10.0; }, table);
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
  });
}
