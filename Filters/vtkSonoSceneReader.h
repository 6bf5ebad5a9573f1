#ifndef vtkSonoSceneReader_h
#define vtkSonoSceneReader_h

#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

/**
 * @class vtkSonoSceneReader
 * @brief Reads a scene from a .nvdb file
 *
 * Gives what vtkSonoSceneBuilder gave when vtkSonoSceneWriter wrote the file: one block a label with its surface, the
 * label table, and the scene itself for the ray tracer. The file holds the tissues that the labels use; targets may
 * take theirs from the bundled table too.
 */
class VTKSONOFILTERS_EXPORT vtkSonoSceneReader : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkSonoSceneReader* New();
  vtkTypeMacro(vtkSonoSceneReader, vtkMultiBlockDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the file.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  /**
   * Whether the name ends in .nvdb.
   */
  static int CanReadFile(const char* fileName);

protected:
  vtkSonoSceneReader();
  ~vtkSonoSceneReader() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoSceneReader(const vtkSonoSceneReader&) = delete;
  void operator=(const vtkSonoSceneReader&) = delete;

  std::string FileName;
};

#endif
