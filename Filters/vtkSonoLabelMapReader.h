#ifndef vtkSonoLabelMapReader_h
#define vtkSonoLabelMapReader_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkImageData;

namespace sono {
struct LabelVolume;
class ReadFiles;
}

/**
 * @class vtkSonoLabelMapReader
 * @brief Reads a label map and places it in the world
 *
 * Reads NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd), MetaImage (.mha, .mhd) and VTK images (.vti, whose point
 * scalars are the labels and whose field data may name them as this reader's does), DICOM Segmentations (.dcm), and a
 * folder of masks (vtkSonoMaskFolderReader). Where structures overlap, the one with fewer voxels counts, and a warning
 * says so once. The output has unsigned short point
 * scalars "Labels" and stands in world coordinates, LPS mm, with its direction matrix. Its field data name the labels
 * that occur: LabelIds, LabelNames, LabelColors (red, green, blue from 0 to 1) and, where there are any,
 * LabelCodes, one row a label. Where the label map
 * names none, a table beside it does (CSV, ITK-SNAP .label, 3D Slicer .ctbl, BIDS .tsv or .txt).
 *
 * Several files, or a NIfTI file with a fourth axis, are the phases of a motion: time steps 0, 1, 2, ... for files, in
 * seconds for NIfTI. All have the same number of voxels along each axis. The point array DisplacementMm and the field
 * array MovingLabels of a .vti file are passed on.
 */
class VTKSONOFILTERS_EXPORT vtkSonoLabelMapReader : public vtkImageAlgorithm
{
public:
  static vtkSonoLabelMapReader* New();
  vtkTypeMacro(vtkSonoLabelMapReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Path of the only label map.
   */
  virtual void SetFileName(const char* fileName);

  ///@{
  /**
   * Paths of the label maps, one a phase.
   */
  void AddFileName(const char* fileName);
  void RemoveAllFileNames();
  int GetNumberOfFileNames() const { return static_cast<int>(this->FileNames.size()); }
  ///@}

  ///@{
  /**
   * Whose numbers the labels have, where the file does not name them: "From File" asks the file and the table beside
   * it; "TotalSegmentator v2", "TotalSegmentator v1 or MONAI", "TotalSegmentator MR", "AMOS", "BTCV", "FLARE", "CT-ORG"
   * and "SPL Abdomen" are lists of numbers that come with SonoVDB (label_lists), whose names count then. Default From
   * File.
   */
  vtkSetStdStringFromCharMacro(LabelNames);
  vtkGetCharFromStdStringMacro(LabelNames);
  ///@}

  /**
   * Whether the name ends like a label map's; of .dcm only segmentations are.
   */
  static int CanReadFile(const char* fileName);

  /**
   * What tells the output, without reading it: the content of the files and the settings. Empty for phases, for data in
   * a file beside their header, where a file has changed since it was read, and where there is something to say of how
   * it was read, so that it is said again.
   */
  std::string ContentKey();

protected:
  vtkSonoLabelMapReader();
  ~vtkSonoLabelMapReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  std::vector<std::string> FileNames;

private:
  vtkSonoLabelMapReader(const vtkSonoLabelMapReader&) = delete;
  void operator=(const vtkSonoLabelMapReader&) = delete;

  /// Of a .vti file also the image that it holds.
  sono::LabelVolume ReadPhase(int phase, vtkImageData* vti);
  std::vector<std::string> FilesToRead() const;

  std::string LabelNames = "From File";
  std::vector<double> Times; // of the phases
  std::unique_ptr<sono::ReadFiles> Files;
  std::set<std::string> Noticed; // what was said of the files: once is enough
};

#endif
