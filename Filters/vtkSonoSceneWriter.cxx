#include "vtkSonoSceneWriter.h"

#include "Scene/SceneFile.h"
#include "SonoStage.h"
#include "vtkSonoSceneHandle.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkSonoSceneWriter);

vtkSonoSceneWriter::vtkSonoSceneWriter() = default;
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
  bool written = false;
  const int ok = sono::announceStage(this, [&] {
    if (this->FileName.empty())
    {
      throw sono::Error("No scene file is named; set FileName to one that ends in .nvdb or .vdb.");
    }
    const auto scene = vtkSonoSceneHandle::Get(vtkMultiBlockDataSet::SafeDownCast(this->GetInput()));
    sono::writeScene(this->FileName, *scene, sono::progressOf(this));
    written = true;
  });
  this->SetErrorCode(written ? vtkErrorCode::NoError : vtkErrorCode::CannotOpenFileError);
  if (ok && !written)
  {
    vtkWarningMacro("Stopped: '" << this->FileName << "' was not written; save it again.");
  }
}
