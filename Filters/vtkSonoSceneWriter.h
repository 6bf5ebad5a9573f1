#ifndef vtkSonoSceneWriter_h
#define vtkSonoSceneWriter_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkWriter.h"

#include <string>

/**
 * @class vtkSonoSceneWriter
 * @brief Writes a scene to a file
 *
 * Takes the output of vtkSonoSceneBuilder or vtkSonoSceneReader and writes the label grid and each label's voxels and
 * signed distances, with names, colours, tissues and placement. A name that ends in .nvdb gives a NanoVDB file, which
 * vtkSonoSceneReader reads; one in .vdb gives an OpenVDB file for other programs. Surfaces that have not been built yet
 * are built first.
 */
class VTKSONOFILTERS_EXPORT vtkSonoSceneWriter : public vtkWriter
{
public:
  static vtkSonoSceneWriter* New();
  vtkTypeMacro(vtkSonoSceneWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the file, ending in .nvdb or .vdb.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

protected:
  vtkSonoSceneWriter();
  ~vtkSonoSceneWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkSonoSceneWriter(const vtkSonoSceneWriter&) = delete;
  void operator=(const vtkSonoSceneWriter&) = delete;

  std::string FileName;
};

#endif
