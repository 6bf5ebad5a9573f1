#include "vtkSonoVentricleVolume.h"

#include "Core/Require.h"
#include "Image/Calipers.h"
#include "SonoFlatDrawing.h"
#include "SonoGreyImage.h"
#include "SonoLabelImage.h"
#include "SonoProbeField.h"
#include "SonoStage.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>
#include <utility>

vtkStandardNewMacro(vtkSonoVentricleVolume);

namespace {

using sono::Vec2d;

/// Ids of the labels whose name has all of the words; of several with different tissues those of blood.
std::set<int> labelsOf(const std::vector<sono::LabelInfo>& labels, const std::string& words)
{
  const auto lower = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
  };
  std::set<int> all;
  std::set<int> ofBlood;
  for (const sono::LabelInfo& label : labels)
  {
    const std::string name = lower(label.name);
    std::istringstream each(lower(words));
    bool hasAll = true;
    for (std::string word; each >> word;)
    {
      hasAll = hasAll && name.find(word) != std::string::npos;
    }
    if (hasAll)
    {
      all.insert(label.id);
    }
    if (hasAll && (label.tissue == "blood" || name.find("blood") != std::string::npos))
    {
      ofBlood.insert(label.id);
    }
  }
  return ofBlood.empty() ? all : ofBlood;
}

std::vector<Vec2d> contourOfLabels(vtkImageData* image, const std::string& ventricle, const std::string& atrium)
{
  vtkDataArray* labels = image->GetPointData()->GetArray("Labels");
  vtkDataArray* mask = image->GetPointData()->GetArray("Mask");
  if (!labels || !mask)
  {
    throw sono::Error(
      "The image has no point arrays 'Labels' and 'Mask'; connect the Flat Image of Simulate Ultrasound.");
  }
  const std::vector<sono::LabelInfo> names = sono::labelTableOf(image->GetFieldData());
  const std::set<int> inside = labelsOf(names, ventricle);
  const std::set<int> above = labelsOf(names, atrium);
  if (inside.empty() || above.empty())
  {
    throw sono::Error("There is no label '" + (inside.empty() ? ventricle : atrium) +
                      "' in the flat image; name the ventricle and its atrium as the label map does.");
  }
  const int* size = image->GetDimensions();
  const auto isOf = [&](const std::set<int>& ids, int x, int y) {
    const vtkIdType at = vtkIdType(y) * size[0] + x;
    return x >= 0 && y >= 0 && x < size[0] && y < size[1] && mask->GetTuple1(at) != 0.0 &&
           ids.count(int(labels->GetTuple1(at))) > 0;
  };
  const auto loop = sono::outlineOf(size[0], size[1], [&](int x, int y) { return isOf(inside, x, y); });
  Vec2d atriumSum(0.0);
  double atriumPixels = 0.0;
  for (int y = 0; y < size[1]; ++y)
  {
    for (int x = 0; x < size[0]; ++x)
    {
      if (isOf(above, x, y))
      {
        atriumSum += Vec2d(x, y);
        atriumPixels += 1.0;
      }
    }
  }
  if (loop.empty() || atriumPixels == 0.0)
  {
    return {}; // not in this picture
  }
  std::vector<Vec2d> contour;
  for (const Vec2d& p : sono::convexContour(loop, atriumSum / atriumPixels))
  {
    contour.emplace_back(image->GetOrigin()[0] + image->GetSpacing()[0] * p.x,
                         image->GetOrigin()[1] + image->GetSpacing()[1] * p.y);
  }
  return contour;
}

bool isVentricle(const std::vector<Vec2d>& contour)
{
  const sono::TracedVentricle traced = sono::tracedVentricle(contour);
  return contour.size() >= 3 && glm::length(traced.apex - traced.base) > 0.0;
}

void draw(const std::vector<Vec2d>& contour, int discs, const std::string& text, double digitMm, vtkPolyData* output)
{
  sono::FlatDrawing drawing;
  drawing.setColor({ 255, 230, 80 });
  const double armMm = 0.35 * digitMm;
  constexpr std::size_t fewPoints = 60; // of a hand; a label's outline has one at each pixel
  for (std::size_t i = 0; i < contour.size(); ++i)
  {
    const Vec2d& p = contour[i];
    if (contour.size() <= fewPoints)
    {
      drawing.stroke(p.x - armMm, p.y, p.x + armMm, p.y);
      drawing.stroke(p.x, p.y - armMm, p.x, p.y + armMm);
    }
    if (i > 0)
    {
      drawing.stroke(contour[i - 1].x, contour[i - 1].y, p.x, p.y);
    }
  }
  if (isVentricle(contour))
  {
    const sono::TracedVentricle traced = sono::tracedVentricle(contour);
    const Vec2d axis = traced.apex - traced.base;
    drawing.stroke(contour.front().x, contour.front().y, contour.back().x, contour.back().y);
    drawing.setColor({ 110, 190, 255 });
    drawing.stroke(traced.base.x, traced.base.y, traced.apex.x, traced.apex.y);
    for (const auto& [a, b] : sono::discEnds(traced, discs))
    {
      drawing.stroke(a.x, a.y, b.x, b.y);
    }
    const double right =
      std::max_element(contour.begin(), contour.end(), [](const Vec2d& a, const Vec2d& b) { return a.x < b.x; })->x;
    drawing.setColor({ 255, 230, 80 });
    drawing.text(text, right + 2.0 * armMm, traced.base.y + 0.5 * axis.y, digitMm, sono::FlatDrawing::Align::Left);
  }
  drawing.finish(output);
}

} // namespace

vtkSonoVentricleVolume::vtkSonoVentricleVolume()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

vtkSonoVentricleVolume::~vtkSonoVentricleVolume() = default;

void vtkSonoVentricleVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Contour: " << this->Contour << endl;
  os << indent << "Ventricle: " << this->Ventricle << endl;
  os << indent << "Atrium: " << this->Atrium << endl;
  os << indent << "PointsMm: " << this->PointsMm[0].size() << " and " << this->PointsMm[1].size() << endl;
  os << indent << "Discs: " << this->Discs << endl;
  os << indent << "DigitMm: " << this->DigitMm << endl;
}

void vtkSonoVentricleVolume::AddFourChamberPoint(double lateralMm, double depthMm)
{
  this->PointsMm[0].push_back({ lateralMm, depthMm });
  this->Modified();
}

void vtkSonoVentricleVolume::ClearFourChamberPoints()
{
  this->PointsMm[0].clear();
  this->Modified();
}

void vtkSonoVentricleVolume::AddTwoChamberPoint(double lateralMm, double depthMm)
{
  this->PointsMm[1].push_back({ lateralMm, depthMm });
  this->Modified();
}

void vtkSonoVentricleVolume::ClearTwoChamberPoints()
{
  this->PointsMm[1].clear();
  this->Modified();
}

int vtkSonoVentricleVolume::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), port);
  return 1;
}

int vtkSonoVentricleVolume::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector*)
{
  return sono::requestWholeImage(input) &&
         (input[1]->GetNumberOfInformationObjects() == 0 || sono::requestWholeImage(input, 1));
}

int vtkSonoVentricleVolume::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    constexpr int mostDiscs = 200;
    sono::requireInRange(this->Discs >= 1 && this->Discs <= mostDiscs, "number of discs", this->Discs, "1 to 200");
    std::array<std::vector<Vec2d>, 2> contours;
    for (int view = 0; view < 2; ++view)
    {
      vtkImageData* image =
        input[view]->GetNumberOfInformationObjects() > 0 ? vtkImageData::GetData(input[view]) : nullptr;
      if (image && this->Contour == Labels)
      {
        contours[view] = contourOfLabels(image, this->Ventricle, this->Atrium);
      }
      else if (image)
      {
        for (const auto& p : this->PointsMm[view])
        {
          contours[view].emplace_back(p[0], p[1]);
        }
      }
    }
    std::array<bool, 2> has{ isVentricle(contours[0]), isVentricle(contours[1]) };
    std::vector<std::pair<const char*, double>> numbers;
    std::string text;
    if (has[0] || has[1])
    {
      const std::array<sono::TracedVentricle, 2> traced{ sono::tracedVentricle(contours[0]),
                                                         sono::tracedVentricle(contours[1]) };
      double lengthMm = 0.0;
      double volumeMl = 0.0;
      for (int view = 0; view < 2; ++view)
      {
        if (has[view])
        {
          lengthMm = std::max(lengthMm, glm::length(traced[view].apex - traced[view].base));
          volumeMl = sono::singlePlaneVolumeMl(traced[view], this->Discs);
          numbers.emplace_back(view == 0 ? "FourChamberMl" : "TwoChamberMl", volumeMl);
        }
      }
      const bool isBiplane = has[0] && has[1];
      volumeMl = isBiplane ? sono::biplaneVolumeMl(traced[0], traced[1], this->Discs) : volumeMl;
      numbers.emplace_back("VolumeMl", volumeMl);
      numbers.emplace_back("LengthMm", lengthMm);
      char words[64];
      std::snprintf(words, sizeof words, "%.1f ml %s", volumeMl, isBiplane ? "biplane" : "single plane");
      text = words;
    }
    for (int view = 0; view < 2; ++view)
    {
      vtkPolyData* polyData = vtkPolyData::GetData(output, view);
      draw(contours[view], this->Discs, text, this->DigitMm, polyData);
      for (const auto& [name, value] : numbers)
      {
        sono::writeNumber(name, value, polyData->GetFieldData());
      }
      vtkNew<vtkStringArray> words;
      words->SetName("Text");
      words->InsertNextValue(text);
      polyData->GetFieldData()->AddArray(words);
    }
  });
}
