#include "vtkSonoSceneReader.h"

#include "Labels/TissueTable.h"
#include "Scene/SceneFile.h"
#include "SonoDataFile.h"
#include "SonoLabelImage.h"
#include "SonoSceneBlocks.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"

#include <vtksys/SystemTools.hxx>

vtkStandardNewMacro(vtkSonoSceneReader);

namespace {

/// The scene's tissues, then those of the bundled table that the scene does not define.
std::shared_ptr<const sono::TissueTable> tissueTable(const sono::Scene& scene)
{
  const auto table = std::make_shared<sono::TissueTable>();
  for (const sono::Tissue& tissue : scene.tissues())
  {
    table->add(tissue);
  }
  const auto bundled = sono::TissueTable::read(sono::dataFile("tissues.csv"));
  for (const sono::Tissue& tissue : bundled.tissues())
  {
    if (!table->find(tissue.name))
    {
      table->add(tissue);
    }
  }
  return table;
}

} // namespace

vtkSonoSceneReader::vtkSonoSceneReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetProgressText("Reading the scene");
}

vtkSonoSceneReader::~vtkSonoSceneReader() = default;

void vtkSonoSceneReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
}

int vtkSonoSceneReader::CanReadFile(const char* fileName)
{
  return fileName && vtksys::SystemTools::StringEndsWith(vtksys::SystemTools::LowerCase(fileName), ".nvdb");
}

int vtkSonoSceneReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  return sono::runStage(this, output, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No scene file is named; set FileName to a .nvdb file that SonoVDB wrote.");
    }
    const sono::Progress progress = sono::progressOf(this);
    const std::shared_ptr<const sono::Scene> scene = sono::readScene(this->FileName, sono::partOf(progress, 0.0, 0.5));
    vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(output);
    sono::addLabelSurfaces(*scene, blocks, sono::partOf(progress, 0.5, 1.0));
    sono::writeLabelTable(scene->volume().labels, blocks->GetFieldData());
    vtkSonoSceneHandle::Attach(scene, tissueTable(*scene), blocks);
  });
}
