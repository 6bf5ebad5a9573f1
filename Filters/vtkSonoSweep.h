#ifndef vtkSonoSweep_h
#define vtkSonoSweep_h

#include "vtkImageAlgorithm.h"
#include "vtkSmartPointer.h"      // for the stages
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

namespace sono {
class Anatomy;
class Simulator;
}
class vtkSonoBMode;
class vtkSonoImageFormation;
class vtkSonoRayTracer;
class vtkSonoSceneBuilder;
class vtkUnsignedCharArray;
class vtkUnsignedShortArray;

/**
 * @class vtkSonoSweep
 * @brief Simulates an ultrasound image of each pose of a probe
 *
 * Inputs: a label image, or a scene that vtkSonoSceneBuilder or vtkSonoSceneReader made (port 0); a probe of
 * vtkSonoProbeSource (port 1), whose own pose is not used; and the poses (port 2), in world coordinates, LPS mm, either
 * as points with the point arrays "Axial" (into the body) and "Lateral" (along the array), three components each, or as
 * a table with the columns "PositionX", "PositionY", "PositionZ", "AxialX", ... and "LateralX", ... . "Lateral" is made
 * orthogonal to "Axial", and both are made of length 1.
 *
 * Output 0: the images flat, each in the probe's own frame as of output 1 of vtkSonoScanConverter, one on the other: x
 * lateral and y depth in mm, z the number of the pose. Point arrays: "BMode" (1, black, to 255 in the scanned area, 0
 * outside), "Mask" (1 inside it) and, unless WithLabels is off, "Labels": the label of the scene's nearest voxel. The
 * probe and the poses ("PosePositionMm", "PoseAxial", "PoseLateral") are in the field data.
 * Output 1: the poses as they were used, a table of the columns above, a row an image.
 *
 * On a GPU the poses go through the stages in groups, and bytes alone come back. Interrupted, the filter leaves no
 * images. A matrix probe, whose images are volumes, is refused.
 *
 * The settings are those of the stages: ask for a stage, and set it up. They start as those of vtkSonoUltrasound.
 */
class VTKSONOFILTERS_EXPORT vtkSonoSweep : public vtkImageAlgorithm
{
public:
  static vtkSonoSweep* New();
  vtkTypeMacro(vtkSonoSweep, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The stages that have the settings. One that is given takes the place of the filter's own; null is ignored. The
   * scene builder's are not used where the input is a scene.
   */
  void SetSceneBuilder(vtkSonoSceneBuilder* stage);
  vtkSonoSceneBuilder* GetSceneBuilder();
  void SetRayTracer(vtkSonoRayTracer* stage);
  vtkSonoRayTracer* GetRayTracer();
  void SetImageFormation(vtkSonoImageFormation* stage);
  vtkSonoImageFormation* GetImageFormation();
  void SetBMode(vtkSonoBMode* stage);
  vtkSonoBMode* GetBMode();
  ///@}

  /**
   * A change of a stage is a change of this filter.
   */
  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * Edge of a square pixel in mm, above 0. Default 0.23.
   */
  vtkSetMacro(PixelMm, double);
  vtkGetMacro(PixelMm, double);
  ///@}

  ///@{
  /**
   * Whether to give the label at each pixel. Default on.
   */
  vtkSetMacro(WithLabels, bool);
  vtkGetMacro(WithLabels, bool);
  vtkBooleanMacro(WithLabels, bool);
  ///@}

protected:
  vtkSonoSweep();
  ~vtkSonoSweep() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoSweep(const vtkSonoSweep&) = delete;
  void operator=(const vtkSonoSweep&) = delete;

  void HideSurfaces();

  vtkSmartPointer<vtkSonoSceneBuilder> SceneBuilder;
  vtkSmartPointer<vtkSonoRayTracer> RayTracer;
  vtkSmartPointer<vtkSonoImageFormation> ImageFormation;
  vtkSmartPointer<vtkSonoBMode> BMode;
  std::unique_ptr<sono::Anatomy> Anatomy; // of the scene builder
  double PixelMm = 0.23;
  bool WithLabels = true;
  std::unique_ptr<sono::Simulator> Simulator;
  // The output's, kept so that the next run can write to the same memory.
  vtkSmartPointer<vtkUnsignedCharArray> Grey;
  vtkSmartPointer<vtkUnsignedCharArray> Mask;
  vtkSmartPointer<vtkUnsignedShortArray> Labels;
};

#endif
