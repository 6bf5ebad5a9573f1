#include "vtkSonoTextFile.h"

#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

#include <filesystem>
#include <fstream>
#include <system_error>

vtkStandardNewMacro(vtkSonoTextFile);

vtkSonoTextFile::vtkSonoTextFile() = default;
vtkSonoTextFile::~vtkSonoTextFile() = default;

void vtkSonoTextFile::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "Text: " << this->Text.size() << " bytes" << endl;
  os << indent << "Refusal: " << this->Refusal << endl;
}

void vtkSonoTextFile::Write()
{
  auto* ranks = vtkMultiProcessController::GetGlobalController();
  if (ranks && ranks->GetLocalProcessId() > 0)
  {
    return;
  }
  const std::string part = this->FileName + ".part";
  std::ofstream stream(part, std::ios::binary);
  stream << this->Text;
  stream.close();
  std::error_code failed;
  if (stream)
  {
    std::filesystem::rename(part, this->FileName, failed);
  }
  if (!stream || failed)
  {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    this->Refusal =
      "Cannot write '" + this->FileName + "'; choose a folder that exists and where you may write, with room left.";
    return;
  }
  this->Refusal.clear();
}

const char* vtkSonoTextFile::GetRefusal()
{
  return this->Refusal.c_str();
}
