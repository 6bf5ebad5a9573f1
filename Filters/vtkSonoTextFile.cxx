#include "vtkSonoTextFile.h"

#include "Core/WholeFile.h"

#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

#include <ostream>

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
  if (!sono::writeWholeFile(this->FileName, [this](std::ostream& stream) { stream << this->Text; }))
  {
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
