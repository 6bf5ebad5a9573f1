#ifndef vtkSonoMaskFolderReader_h
#define vtkSonoMaskFolderReader_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkSonoLabelMapReader.h"

/**
 * @class vtkSonoMaskFolderReader
 * @brief Reads a folder of masks as one label map
 *
 * One NIfTI, NRRD or MetaImage file a structure, 0 outside it and one other number inside, named as the structure: what
 * TotalSegmentator writes. The files in the order of their names are the labels 1, 2, 3, ...; empty masks keep their
 * numbers. Where masks overlap, the one with fewer voxels counts, and a warning says so once. The output is that of
 * vtkSonoLabelMapReader.
 */
class VTKSONOFILTERS_EXPORT vtkSonoMaskFolderReader : public vtkSonoLabelMapReader
{
public:
  static vtkSonoMaskFolderReader* New();
  vtkTypeMacro(vtkSonoMaskFolderReader, vtkSonoLabelMapReader);

  ///@{
  /**
   * Path of the folder, or of one of its files; the folder's is got.
   */
  void SetFileName(const char* path) override;
  const char* GetFileName() const { return this->FileNames.empty() ? "" : this->FileNames.front().c_str(); }
  ///@}

  /**
   * Whether the path is a folder with files of label maps, or a mask with others beside it.
   */
  static int CanReadFile(const char* path);

protected:
  vtkSonoMaskFolderReader() = default;
  ~vtkSonoMaskFolderReader() override = default;

private:
  vtkSonoMaskFolderReader(const vtkSonoMaskFolderReader&) = delete;
  void operator=(const vtkSonoMaskFolderReader&) = delete;
};

#endif
