#include "vtkSonoFlatLabels.h"

#include "SonoGreyImage.h"
#include "SonoImagePlacement.h"
#include "SonoLabelImage.h"
#include "SonoStage.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

vtkStandardNewMacro(vtkSonoFlatLabels);

namespace {

class Outlines
{
public:
  explicit Outlines(vtkImageData* image)
    : image_(image)
    , labels_(image)
    , counts_(65536, 0)
  {
    mask_ = vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetArray("Mask"));
    if (!mask_)
    {
      throw sono::Error("The image has no point array 'Mask'; connect the Flat Image of Simulate Ultrasound.");
    }
    for (const sono::LabelInfo& label : sono::labelTableOf(image->GetFieldData()))
    {
      colors_[label.id] = sono::displayColor(label);
    }
    label_->SetName("Label");
    color_->SetName("Color");
    color_->SetNumberOfComponents(3);
  }

  void draw(vtkPolyData* polyData)
  {
    const vtkIdType count = mask_->GetNumberOfValues();
    for (vtkIdType i = 0; i < count; ++i)
    {
      counts_[labels_.at(0)[i]] += mask_->GetValue(i) ? 1 : 0;
    }
    for (int y = 0; y < labels_.height(); ++y)
    {
      for (int x = 0; x < labels_.width(); ++x)
      {
        this->drawBetween(x, y, 1, 0);
        this->drawBetween(x, y, 0, 1);
      }
    }
    polyData->SetPoints(points_);
    polyData->SetLines(lines_);
    polyData->GetCellData()->AddArray(label_);
    polyData->GetCellData()->AddArray(color_);
  }

private:
  /// The edge between a pixel and the next one to the right or below.
  void drawBetween(int x, int y, int right, int down)
  {
    if (x + right >= labels_.width() || y + down >= labels_.height())
    {
      return;
    }
    const vtkIdType here = vtkIdType(y) * labels_.width() + x;
    const vtkIdType next = here + right + vtkIdType(down) * labels_.width();
    const std::uint16_t a = labels_.at(0)[here];
    const std::uint16_t b = labels_.at(0)[next];
    if (a == b || !mask_->GetValue(here) || !mask_->GetValue(next))
    {
      return;
    }
    const double cornerX = x + (right ? 0.5 : -0.5);
    const double cornerY = y + (down ? 0.5 : -0.5);
    lines_->InsertNextCell({ this->point(cornerX, cornerY), this->point(cornerX + down, cornerY + right) });
    const int label = counts_[a] <= counts_[b] ? a : b;
    label_->InsertNextValue(label);
    for (const float channel : colors_[label])
    {
      color_->InsertNextValue(static_cast<unsigned char>(255.0f * channel + 0.5f));
    }
  }

  vtkIdType point(double column, double row)
  {
    const double* origin = image_->GetOrigin();
    const double* spacing = image_->GetSpacing();
    return points_->InsertNextPoint(origin[0] + spacing[0] * column, origin[1] + spacing[1] * row, sono::flatDrawingMm);
  }

  vtkImageData* image_;
  sono::LabelSlices labels_;
  std::map<int, std::array<float, 3>> colors_; ///< of a label without one black
  vtkUnsignedCharArray* mask_;
  std::vector<long> counts_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> lines_;
  vtkNew<vtkIntArray> label_;
  vtkNew<vtkUnsignedCharArray> color_;
};

} // namespace

vtkSonoFlatLabels::vtkSonoFlatLabels() = default;
vtkSonoFlatLabels::~vtkSonoFlatLabels() = default;

void vtkSonoFlatLabels::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

int vtkSonoFlatLabels::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoFlatLabels::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input);
}

int vtkSonoFlatLabels::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    vtkImageData* image = vtkImageData::GetData(input[0]);
    if (image->GetDimensions()[2] == 1)
    {
      Outlines(image).draw(vtkPolyData::GetData(output));
    }
  });
}
