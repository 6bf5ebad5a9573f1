#include "vtkSonoSceneWriter.h"

#include "Scene/SceneFile.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoSceneWriter);

vtkSonoSceneWriter::vtkSonoSceneWriter()
{
  this->SetProgressText("Writing the scene");
}

vtkSonoSceneWriter::~vtkSonoSceneWriter() = default;

void vtkSonoSceneWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
}

int vtkSonoSceneWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  return 1;
}

void vtkSonoSceneWriter::WriteData()
{
  bool isWritten = false;
  const bool isRun = sono::runWork(this, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No scene file is named; set FileName to one that ends in .nvdb or .vdb.");
    }
    const auto scene = vtkSonoSceneHandle::Get(vtkMultiBlockDataSet::SafeDownCast(this->GetInput()));
    sono::writeScene(this->FileName, *scene, sono::progressOf(this));
    isWritten = true;
  });
  this->SetErrorCode(isWritten ? vtkErrorCode::NoError : vtkErrorCode::CannotOpenFileError);
  if (isRun && !isWritten)
  {
    sono::warn(this, "Stopped: '" + this->FileName + "' was not written; save it again.");
  }
}
