#ifndef vtkSonoFlatLabels_h
#define vtkSonoFlatLabels_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

/**
 * @class vtkSonoFlatLabels
 * @brief The outlines of an image's labels, to lie over the flat image
 *
 * Takes the flat image of vtkSonoUltrasound or vtkSonoScanConverter, with its point arrays "Labels" and "Mask" and the
 * table of labels in its field data. The output lies in the frame of that image, mm, a hair in front of it as seen with
 * the transducer on top: one stroke between each two neighbouring pixels of the scanned area whose labels differ, along
 * the pixels' edges. Its cell array "Label" is, of the two, the label with fewer pixels in the picture, which is mostly
 * the inner one, and "Color" is that one's, RGB. For a volume the output is empty. The error names an image without
 * labels.
 */
class VTKSONOFILTERS_EXPORT vtkSonoFlatLabels : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoFlatLabels* New();
  vtkTypeMacro(vtkSonoFlatLabels, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSonoFlatLabels();
  ~vtkSonoFlatLabels() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoFlatLabels(const vtkSonoFlatLabels&) = delete;
  void operator=(const vtkSonoFlatLabels&) = delete;
};

#endif
