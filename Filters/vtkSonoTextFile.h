#ifndef vtkSonoTextFile_h
#define vtkSonoTextFile_h

#include "vtkObject.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

/**
 * @class vtkSonoTextFile
 * @brief Writes a text where the data are
 *
 * As a proxy it lives on the server, so that what an editor saves lies where the server's filters can read it.
 */
class VTKSONOFILTERS_EXPORT vtkSonoTextFile : public vtkObject
{
public:
  static vtkSonoTextFile* New();
  vtkTypeMacro(vtkSonoTextFile, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Where to write; a file of that name is replaced. Default empty.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  ///@{
  /**
   * What to write, as UTF-8. Default empty.
   */
  vtkSetStdStringFromCharMacro(Text);
  vtkGetCharFromStdStringMacro(Text);
  ///@}

  /**
   * Writes the text; where that fails, an older file of the name is left as it was. In parallel the first rank writes.
   */
  void Write();

  /**
   * What went wrong in the last Write(), one sentence; empty when nothing did.
   */
  const char* GetRefusal();

protected:
  vtkSonoTextFile();
  ~vtkSonoTextFile() override;

private:
  vtkSonoTextFile(const vtkSonoTextFile&) = delete;
  void operator=(const vtkSonoTextFile&) = delete;

  std::string FileName;
  std::string Text;
  std::string Refusal;
};

#endif
