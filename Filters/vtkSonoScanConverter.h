#ifndef vtkSonoScanConverter_h
#define vtkSonoScanConverter_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

namespace sono {
class Display;
class Simulator;
struct DisplaySettings;
struct LabelVolume;
}

/**
 * @class vtkSonoScanConverter
 * @brief Brings scan lines into their places in the world
 *
 * Takes the output of vtkSonoBMode (port 0). The output stands in world coordinates, LPS mm, by its direction matrix.
 * It is an image in the probe's plane, x along the array (lateral), y into the body (axial), z = axial x lateral
 * (elevation); of a matrix it is a volume, x lateral, y elevation, z axial.
 *
 * Its point arrays are "BMode" (1, black, to 255 in the scanned area, 0 outside), "Mask" (1 inside it) and, as the
 * ground truth, "Labels": the label of the voxel nearest to what is shown there (in the model Acoustic range is time,
 * and that lies deeper or less deep than the pixel), 0 outside the mask and outside the label map. The label map is
 * that of the optional port 1, an image whose active point scalars are labels, else that of the scene that was traced;
 * its names and colours are in the field data. Without either there are no "Labels".
 *
 * Output 1 is the same image in the probe's own frame, mm, to look at it flat: x lateral, y range, 0 at the centre of
 * the transducer's face; of a matrix's volume the plane in the middle, up to half a voxel beside it.
 */
class VTKSONOFILTERS_EXPORT vtkSonoScanConverter : public vtkImageAlgorithm
{
public:
  static vtkSonoScanConverter* New();
  vtkTypeMacro(vtkSonoScanConverter, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of a square pixel, in mm, above 0; at most 2^28 of them. Of a matrix the edge of a cubic voxel, or as much
   * wider as 2^25 of them fill the volume. Twice as wide while the probe is being moved. Default 0.23.
   */
  vtkSetMacro(PixelMm, double);
  vtkGetMacro(PixelMm, double);
  ///@}

  ///@{
  /**
   * What a scanner does to the finished image. Units, ranges, defaults and what they do: sono::DisplaySettings. The
   * images that persistence averages are those of the input's time steps.
   */
  sonoParameter(Persistence, double);
  sonoParameter(SpeckleReduction, int);
  sonoParameter(SpeckleThreshold, double);
  const sono::DisplaySettings& DisplaySettings() const;
  ///@}

protected:
  vtkSonoScanConverter();
  ~vtkSonoScanConverter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoScanConverter(const vtkSonoScanConverter&) = delete;
  void operator=(const vtkSonoScanConverter&) = delete;

  std::shared_ptr<const sono::LabelVolume> ConnectedLabels(vtkImageData* image);

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::unique_ptr<sono::Simulator> Simulator;
  std::unique_ptr<sono::Display> Display;
  double PixelMm = 0.23;
  std::shared_ptr<const sono::LabelVolume> Labels; // of port 1, kept while its image is unchanged
  vtkMTimeType LabelsTime = 0;                     // of that image
};

#endif
