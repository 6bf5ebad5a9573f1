#include "vtkSonoFlatPixel.h"

#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <cmath>
#include <cstdio>
#include <optional>

vtkStandardNewMacro(vtkSonoFlatPixel);

namespace {

struct Pixel
{
  int grey = 0;
  int label = -1; ///< none
  double depthMm = 0.0;
  std::string structure;
  std::string tissue;
};

std::string nameIn(const char* array, vtkIdType row, vtkFieldData* fields)
{
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray(array));
  return names && row < names->GetNumberOfValues() ? names->GetValue(row) : std::string();
}

void nameLabel(vtkFieldData* fields, Pixel& pixel)
{
  vtkDataArray* ids = fields->GetArray("LabelIds");
  for (vtkIdType row = 0; ids && row < ids->GetNumberOfTuples(); ++row)
  {
    if (static_cast<int>(ids->GetTuple1(row)) == pixel.label)
    {
      pixel.structure = nameIn("LabelNames", row, fields);
      pixel.tissue = nameIn("LabelTissues", row, fields);
    }
  }
}

/// The nearest pixel of the scanned area. Throws Error for an image that no probe made.
std::optional<Pixel> pixelAt(vtkImageData* image, const double placeMm[2])
{
  vtkDataArray* grey = image->GetPointData()->GetArray("BMode");
  vtkDataArray* mask = image->GetPointData()->GetArray("Mask");
  const int* size = image->GetDimensions();
  const int column = int(std::lround((placeMm[0] - image->GetOrigin()[0]) / image->GetSpacing()[0]));
  const int row = int(std::lround((placeMm[1] - image->GetOrigin()[1]) / image->GetSpacing()[1]));
  if (!grey || size[2] != 1 || column < 0 || column >= size[0] || row < 0 || row >= size[1])
  {
    return std::nullopt;
  }
  const vtkIdType at = vtkIdType(row) * size[0] + column;
  if (mask && mask->GetTuple1(at) == 0.0)
  {
    return std::nullopt;
  }
  Pixel pixel;
  const sono::ScanGeometry geometry = sono::readProbe(image->GetFieldData()).geometry;
  const double depthMm = sono::beamFromPlane(geometry, placeMm[0], placeMm[1]).y;
  pixel.depthMm = std::isnan(depthMm) ? placeMm[1] : depthMm; // of the outermost pixels and of steered fans
  pixel.grey = int(grey->GetTuple1(at));
  if (vtkDataArray* labels = image->GetPointData()->GetArray("Labels"))
  {
    pixel.label = int(labels->GetTuple1(at));
    nameLabel(image->GetFieldData(), pixel);
  }
  return pixel;
}

std::string written(const Pixel& pixel)
{
  std::string words = pixel.structure;
  words += (words.empty() || pixel.tissue.empty() ? "" : ", ") + pixel.tissue;
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "%s%.1f mm, grey %d", words.empty() ? "" : ", ", pixel.depthMm, pixel.grey);
  return words + numbers;
}

template<class Array, class Value>
void addColumn(const char* name, const Value& value, vtkTable* table)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->InsertNextValue(value);
  table->AddColumn(column);
}

} // namespace

vtkSonoFlatPixel::vtkSonoFlatPixel() = default;
vtkSonoFlatPixel::~vtkSonoFlatPixel() = default;

void vtkSonoFlatPixel::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PlaceMm: " << this->PlaceMm[0] << " " << this->PlaceMm[1] << endl;
}

int vtkSonoFlatPixel::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoFlatPixel::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

const char* vtkSonoFlatPixel::GetSentence()
{
  this->Sentence.clear();
  auto* image =
    vtkImageData::SafeDownCast(this->GetNumberOfInputConnections(0) > 0 ? this->GetInputDataObject(0, 0) : nullptr);
  if (image && image->GetFieldData()->HasArray("DepthMm"))
  {
    sono::runWork(this, [&] {
      const std::optional<Pixel> pixel = pixelAt(image, this->PlaceMm);
      this->Sentence = pixel ? written(*pixel) : std::string();
    });
  }
  return this->Sentence.c_str();
}

int vtkSonoFlatPixel::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (const std::optional<Pixel> pixel = pixelAt(vtkImageData::GetData(input[0]), this->PlaceMm))
    {
      vtkTable* table = vtkTable::GetData(output);
      addColumn<vtkStringArray>("Structure", pixel->structure, table);
      addColumn<vtkStringArray>("Tissue", pixel->tissue, table);
      addColumn<vtkIntArray>("Label", pixel->label, table);
      addColumn<vtkDoubleArray>("Depth (mm)", pixel->depthMm, table);
      addColumn<vtkIntArray>("Grey", pixel->grey, table);
    }
  });
}
