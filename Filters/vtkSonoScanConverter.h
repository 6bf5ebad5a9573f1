#ifndef vtkSonoScanConverter_h
#define vtkSonoScanConverter_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

/**
 * @class vtkSonoScanConverter
 * @brief Brings scan lines into their places in the world
 *
 * Takes the output of vtkSonoBMode. The output is an image in the probe's plane that stands in world coordinates, LPS
 * mm, by its direction matrix: x along the array (lateral), y into the body (axial), z = axial x lateral (elevation).
 * Its point arrays are "BMode" (0 to 255, 0 outside the scanned area) and "Mask" (1 inside it).
 */
class VTKSONOFILTERS_EXPORT vtkSonoScanConverter : public vtkImageAlgorithm
{
public:
  static vtkSonoScanConverter* New();
  vtkTypeMacro(vtkSonoScanConverter, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of a square pixel in mm, above 0. Default 0.23.
   */
  vtkSetMacro(PixelMm, double);
  vtkGetMacro(PixelMm, double);
  ///@}

protected:
  vtkSonoScanConverter();
  ~vtkSonoScanConverter() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoScanConverter(const vtkSonoScanConverter&) = delete;
  void operator=(const vtkSonoScanConverter&) = delete;

  double PixelMm = 0.23;
};

#endif
