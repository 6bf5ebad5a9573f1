#include "SonoVtkImageFile.h"

#include "Core/Progress.h"

#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkXMLDataParser.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

// Expat has this from 2.6 on, and Debian 12's 2.5 with its security updates; null where it is older.
extern "C" __attribute__((weak)) unsigned char XML_SetReparseDeferralEnabled(void* parser, unsigned char enabled);

namespace {

/// VTK 9.2 feeds expat up to the appended data, which are no XML, and relies on hearing of each element at once. An
/// expat that puts elements off until more bytes have come makes it fail on every file with appended data.
class PromptParser : public vtkXMLDataParser
{
public:
  static PromptParser* New();
  vtkTypeMacro(PromptParser, vtkXMLDataParser);

protected:
  int CreateParser() override
  {
    const int created = this->Superclass::CreateParser();
    if (created && XML_SetReparseDeferralEnabled)
    {
      XML_SetReparseDeferralEnabled(this->Parser, 0);
    }
    return created;
  }
};
vtkStandardNewMacro(PromptParser);

class PromptReader : public vtkXMLImageDataReader
{
public:
  static PromptReader* New();
  vtkTypeMacro(PromptReader, vtkXMLImageDataReader);

protected:
  void CreateXMLParser() override { this->XMLParser = PromptParser::New(); }
};
vtkStandardNewMacro(PromptReader);

} // namespace

void sono::readVtkImage(const std::string& fileName, vtkImageData* image)
{
  vtkNew<PromptReader> reader;
  if (!vtksys::SystemTools::FileExists(fileName, true) || !reader->CanReadFile(fileName.c_str()))
  {
    throw Error("The file " + fileName + " is missing or no VTK image; name a label map that can be read.");
  }
  reader->SetFileName(fileName.c_str());
  if (!reader->GetExecutive()->Update())
  {
    throw Error("The VTK image " + fileName + " is damaged; write it again.");
  }
  image->ShallowCopy(reader->GetOutput());
}
