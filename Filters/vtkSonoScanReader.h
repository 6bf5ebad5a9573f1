#ifndef vtkSonoScanReader_h
#define vtkSonoScanReader_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>
#include <vector>

namespace sono {
struct IntensityVolume;
class ReadFiles;
}

/**
 * @class vtkSonoScanReader
 * @brief Reads a CT or MR and places it in the world
 *
 * Reads NIfTI, NRRD, MetaImage and, by its folder or one of its files, a DICOM series. The output has point
 * scalars "Intensities" (of a CT, Hounsfield units; shorts where the file has such, else floats) and stands in world
 * coordinates, LPS mm, with its direction matrix. Where the file says which it is, a string array "Modality" in the
 * field data has it: CT or MR.
 */
class VTKSONOFILTERS_EXPORT vtkSonoScanReader : public vtkImageAlgorithm
{
public:
  static vtkSonoScanReader* New();
  vtkTypeMacro(vtkSonoScanReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Path of the file, or of the folder of a DICOM series.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  /**
   * What tells the output, without reading it: the content of its files. Empty where it has changed since it was read,
   * or lies in a file beside its header.
   */
  std::string ContentKey();

protected:
  vtkSonoScanReader();
  ~vtkSonoScanReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoScanReader(const vtkSonoScanReader&) = delete;
  void operator=(const vtkSonoScanReader&) = delete;

  std::vector<std::string> FilesToRead() const;
  std::shared_ptr<const sono::IntensityVolume> Read();

  std::string FileName;
  std::unique_ptr<sono::ReadFiles> Files;
  std::shared_ptr<const sono::IntensityVolume> Series; // from the information pass, which needs its size
};

#endif
