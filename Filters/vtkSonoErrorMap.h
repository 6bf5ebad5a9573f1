#ifndef vtkSonoErrorMap_h
#define vtkSonoErrorMap_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

/**
 * @class vtkSonoErrorMap
 * @brief How exact the traced intensity is, at each place of the image
 *
 * Takes the traced lines of vtkSonoRayTracer. The output is an image, of a matrix a volume, of the size and in the
 * place of that of vtkSonoScanConverter, with the point arrays
 * - "ErrorPercent": the standard error of the traced intensity in percent of that intensity, 0 to 100 (more is not
 *   possible: intensities are not negative); 0 where all paths agree, as before the first boundary, 100 where none
 *   came, not a number outside the scanned area. It falls with the square root of the number of paths.
 * - "Mask": 1 inside the scanned area.
 * While the probe is being moved nothing is known: no pixel is a number and the mask is empty.
 * It is that of the depth which is shown at a pixel. Between lines and radial bins the percentage is interpolated. The
 * speckle is no error and does not count.
 *
 * Output 1 is the same image in the probe's own frame, mm, as of vtkSonoScanConverter.
 */
class VTKSONOFILTERS_EXPORT vtkSonoErrorMap : public vtkImageAlgorithm
{
public:
  static vtkSonoErrorMap* New();
  vtkTypeMacro(vtkSonoErrorMap, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of a square pixel, in mm, above 0; at most 2^28 of them. Of a matrix the edge of a cubic voxel, or as much
   * wider as 2^25 of them fill the volume. Twice as wide while the probe is being moved. Default 0.23.
   */
  vtkSetMacro(PixelMm, double);
  vtkGetMacro(PixelMm, double);
  ///@}

protected:
  vtkSonoErrorMap();
  ~vtkSonoErrorMap() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoErrorMap(const vtkSonoErrorMap&) = delete;
  void operator=(const vtkSonoErrorMap&) = delete;

  double PixelMm = 0.23;
};

#endif
