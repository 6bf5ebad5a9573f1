#include "vtkSonoMaskFolderReader.h"

#include "Labels/ReadMaskFolder.h"

#include "vtkObjectFactory.h"

#include <filesystem>

vtkStandardNewMacro(vtkSonoMaskFolderReader);

void vtkSonoMaskFolderReader::SetFileName(const char* path)
{
  const std::string name = path ? path : "";
  this->Superclass::SetFileName((name.empty() ? name : sono::maskFolderOf(name)).c_str());
}

int vtkSonoMaskFolderReader::CanReadFile(const char* path)
{
  return path && sono::mayBeMasks(path) ? 1 : 0;
}
