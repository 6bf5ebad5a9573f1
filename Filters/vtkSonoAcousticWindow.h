#ifndef vtkSonoAcousticWindow_h
#define vtkSonoAcousticWindow_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

/**
 * @class vtkSonoAcousticWindow
 * @brief Finds a place on the skin from which a probe sees the heart, or another organ
 *
 * Takes a label image or a scene, like vtkSonoUltrasound. The output shows the way of the sound, a line in world
 * coordinates, LPS mm, from the transducer's face to what it looks at; its field data hold the pose: ProbePositionMm,
 * ProbeAxial and ProbeLateral. A label image may bring a pose of its own along in its field data (A4CPositionMm,
 * A4CAxial, A4CLateral, as the bundled thorax does), which is then the answer.
 */
class VTKSONOFILTERS_EXPORT vtkSonoAcousticWindow : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoAcousticWindow* New();
  vtkTypeMacro(vtkSonoAcousticWindow, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the body of a label image is filled first, see vtkSonoSceneBuilder. Default off.
   */
  vtkSetMacro(FillBody, bool);
  vtkGetMacro(FillBody, bool);
  vtkBooleanMacro(FillBody, bool);
  ///@}

  ///@{
  /**
   * Whether the probe looks at TargetMm, or at the middle of the heart's walls, where there are none of the liver,
   * where there is none either of the body. Default off.
   */
  vtkSetMacro(ChooseTarget, bool);
  vtkGetMacro(ChooseTarget, bool);
  vtkBooleanMacro(ChooseTarget, bool);
  ///@}

  ///@{
  /**
   * What the probe looks at, in world coordinates, LPS mm, within the body. Used with ChooseTarget. Default (0, 0, 0).
   */
  vtkSetVector3Macro(TargetMm, double);
  vtkGetVector3Macro(TargetMm, double);
  ///@}

  ///@{
  /**
   * Frequency in MHz, above 0, for which tissues attenuate. Default 2.5.
   */
  vtkSetMacro(CentreFrequencyMHz, double);
  vtkGetMacro(CentreFrequencyMHz, double);
  ///@}

protected:
  vtkSonoAcousticWindow();
  ~vtkSonoAcousticWindow() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoAcousticWindow(const vtkSonoAcousticWindow&) = delete;
  void operator=(const vtkSonoAcousticWindow&) = delete;

  bool FillBody = false;
  bool ChooseTarget = false;
  double TargetMm[3] = { 0.0, 0.0, 0.0 };
  double CentreFrequencyMHz = 2.5;
};

#endif
