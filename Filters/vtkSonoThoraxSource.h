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
 * view: A4CPositionMm (LPS mm), A4CAxial and A4CLateral. With more than one phase the heart beats: a cycle as time
 * steps of 1 / Phases s, each with the point array DisplacementMm and the field array MovingLabels, so that the walls'
 * speckle moves with them.
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

  ///@{
  /**
   * Time steps of a heart cycle of 1 s from the end of diastole on, 1 to 200. Default 1: the heart stands still.
   */
  vtkSetClampMacro(Phases, int, 1, 200);
  vtkGetMacro(Phases, int);
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
  int Phases = 1;
  std::shared_ptr<const sono::LabelVolume> Volume; // from the information pass, which needs its size, to the data pass
};

#endif
