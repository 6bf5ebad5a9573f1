#ifndef vtkSonoThoraxSource_h
#define vtkSonoThoraxSource_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

namespace sono {
struct LabelVolume;
}

/**
 * @class vtkSonoThoraxSource
 * @brief The bundled parametric thorax as a label map
 *
 * The same output as vtkSonoLabelMapReader's. Its field data also hold the probe's pose for the apical four-chamber
 * view: A4CPositionMm (LPS mm), A4CAxial and A4CLateral.
 */
class VTKSONOFILTERS_EXPORT vtkSonoThoraxSource : public vtkImageAlgorithm
{
public:
  static vtkSonoThoraxSource* New();
  vtkTypeMacro(vtkSonoThoraxSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Edge of a voxel in mm, 0.5 to 5. Default 1.
   */
  vtkSetMacro(SpacingMm, double);
  vtkGetMacro(SpacingMm, double);
  ///@}

protected:
  vtkSonoThoraxSource();
  ~vtkSonoThoraxSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoThoraxSource(const vtkSonoThoraxSource&) = delete;
  void operator=(const vtkSonoThoraxSource&) = delete;

  double SpacingMm = 1.0;
  std::shared_ptr<const sono::LabelVolume> Volume; // from the information pass, which needs its size, to the data pass
};

#endif
