#include "vtkSonoLabelTable.h"

#include "Scene/Scene.h"
#include "SonoLabelImage.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <cmath>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkSonoLabelTable);

namespace {

template<class Array, class Value>
void addColumn(const char* name, const std::vector<sono::LabelInfo>& labels, const Value& value, vtkTable* table)
{
  vtkNew<Array> column;
  column->SetName(name);
  for (const sono::LabelInfo& label : labels)
  {
    column->InsertNextValue(value(label));
  }
  table->AddColumn(column);
}

std::string numbersOf(const sono::Tissue& tissue)
{
  std::ostringstream text;
  text.precision(10);
  for (const sono::TissueColumn& column : sono::tissueColumns())
  {
    text << '\t' << tissue.*column.member;
  }
  return text.str();
}

int byte(float part)
{
  return static_cast<int>(std::lround(255.0f * part));
}

/// As columns and as text.
void addLabels(const std::vector<sono::LabelInfo>& labels, vtkTable* table, vtkStringArray* rows)
{
  addColumn<vtkIntArray>(
    "id", labels, [](const auto& label) { return label.id; }, table);
  addColumn<vtkStringArray>(
    "name", labels, [](const auto& label) { return label.name; }, table);
  for (int part = 0; part < 3; ++part)
  {
    const char* names[] = { "red", "green", "blue" };
    addColumn<vtkIntArray>(
      names[part], labels, [=](const auto& label) { return byte(sono::displayColor(label)[part]); }, table);
  }
  addColumn<vtkStringArray>(
    "tissue", labels, [](const auto& label) { return label.tissue; }, table);
  addColumn<vtkIntArray>(
    "guess", labels, [](const auto& label) { return label.guessed ? 1 : 0; }, table);
  rows->InsertNextValue("id\tname\tr\tg\tb\ttissue\tguess");
  for (const sono::LabelInfo& label : labels)
  {
    const auto color = sono::displayColor(label);
    std::ostringstream row;
    row << label.id << '\t' << label.name << '\t' << byte(color[0]) << '\t' << byte(color[1]) << '\t' << byte(color[2])
        << '\t' << label.tissue << '\t' << (label.guessed ? "yes" : "");
    rows->InsertNextValue(row.str());
  }
}

} // namespace

vtkSonoLabelTable::vtkSonoLabelTable()
  : LabelRows(vtkSmartPointer<vtkStringArray>::New())
  , TissueRows(vtkSmartPointer<vtkStringArray>::New())
{
}

vtkSonoLabelTable::~vtkSonoLabelTable() = default;

void vtkSonoLabelTable::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LabelRows: " << this->LabelRows->GetNumberOfValues() << endl;
  os << indent << "TissueRows: " << this->TissueRows->GetNumberOfValues() << endl;
}

vtkStringArray* vtkSonoLabelTable::GetLabelRows()
{
  return this->LabelRows;
}

vtkStringArray* vtkSonoLabelTable::GetTissueRows()
{
  return this->TissueRows;
}

std::string vtkSonoLabelTable::Refusal(const std::string& tissue, const std::string& column, double value)
{
  sono::Tissue changed;
  changed.name = tissue;
  for (const sono::TissueColumn& known : sono::tissueColumns())
  {
    if (column == known.name)
    {
      changed.*known.member = value;
    }
  }
  try
  {
    sono::checkRanges(changed);
    return {};
  }
  catch (const sono::Error& error)
  {
    return error.what();
  }
}

std::string vtkSonoLabelTable::Meaning(const std::string& column)
{
  for (const sono::TissueColumn& known : sono::tissueColumns())
  {
    if (column == known.name)
    {
      return known.meaning;
    }
  }
  return {};
}

int vtkSonoLabelTable::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkSonoLabelTable::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    this->LabelRows->Reset();
    this->TissueRows->Reset();
    vtkTable* table = vtkTable::GetData(output);
    if (vtkImageData* image = vtkImageData::GetData(input[0]))
    {
      addLabels(sono::labelTableOf(image->GetFieldData()), table, this->LabelRows);
      return;
    }
    vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(input[0]);
    const auto scene = vtkSonoSceneHandle::Get(blocks);
    const auto tissues = vtkSonoSceneHandle::GetTissues(blocks->GetFieldData());
    const std::vector<sono::LabelInfo>& labels = scene->volume().labels;
    const auto tissueOf = [&](const sono::LabelInfo& label) -> const sono::Tissue& {
      return scene->tissues()[scene->tissueOfLabel()[std::size_t(label.id)]];
    };

    addLabels(labels, table, this->LabelRows);
    std::string columns = "tissue";
    for (const sono::TissueColumn& column : sono::tissueColumns())
    {
      addColumn<vtkDoubleArray>(
        column.name, labels, [&](const auto& label) { return tissueOf(label).*column.member; }, table);
      columns += std::string("\t") + column.name;
    }
    this->TissueRows->InsertNextValue(columns + "\tsource");
    for (const sono::Tissue& tissue : tissues->tissues())
    {
      this->TissueRows->InsertNextValue(tissue.name + numbersOf(tissue) + '\t' + tissue.source);
    }
  });
}
