#ifndef vtkSonoFlatPixel_h
#define vtkSonoFlatPixel_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

#include <string>

/**
 * @class vtkSonoFlatPixel
 * @brief What a flat image shows at a place: structure, tissue, depth and grey level
 *
 * Takes the flat image of vtkSonoUltrasound or vtkSonoScanConverter. The output has one row with "Structure" and
 * "Tissue" (names of the label and its tissue, empty where the image does not carry them), "Label", "Depth (mm)" along
 * the scan line from the transducer's face, and "Grey", 0 to 255; no row outside of the scanned area, and none of a
 * volume. Sentence says the same of what the input holds by now, without an update: who follows a pointer must not
 * start a simulation.
 */
class VTKSONOFILTERS_EXPORT vtkSonoFlatPixel : public vtkTableAlgorithm
{
public:
  static vtkSonoFlatPixel* New();
  vtkTypeMacro(vtkSonoFlatPixel, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The place in the frame of the flat image in mm: lateral, depth. Default (0, 50).
   */
  vtkSetVector2Macro(PlaceMm, double);
  vtkGetVector2Macro(PlaceMm, double);
  ///@}

  /**
   * "left ventricle, blood, 83.2 mm, grey 12"; empty where there is nothing to say.
   */
  const char* GetSentence();

protected:
  vtkSonoFlatPixel();
  ~vtkSonoFlatPixel() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoFlatPixel(const vtkSonoFlatPixel&) = delete;
  void operator=(const vtkSonoFlatPixel&) = delete;

  double PlaceMm[2] = { 0.0, 50.0 };
  std::string Sentence;
};

#endif
