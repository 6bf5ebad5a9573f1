#ifndef vtkSonoProbePath_h
#define vtkSonoProbePath_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <vector>

/**
 * @class vtkSonoProbePath
 * @brief The way of a probe that was moved by hand: a pose after the other, with times
 *
 * A line through the places of the probe's face, in the label map's world (LPS mm), with the point arrays "Axial" and
 * "Lateral", of length 1 and at right angles, as vtkSonoSweep takes them, and "TimeS", seconds from the first pose.
 */
class VTKSONOFILTERS_EXPORT vtkSonoProbePath : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoProbePath* New();
  vtkTypeMacro(vtkSonoProbePath, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The poses, ten numbers each: time in s, position, axial and lateral direction of any length. Times do not go back.
   */
  void SetNumberOfPoses(int count);
  void SetPose(int index, double timeS, double x, double y, double z, double axialX, double axialY, double axialZ,
               double lateralX, double lateralY, double lateralZ);
  ///@}

protected:
  vtkSonoProbePath();
  ~vtkSonoProbePath() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoProbePath(const vtkSonoProbePath&) = delete;
  void operator=(const vtkSonoProbePath&) = delete;

  int Count() const;

  std::vector<double> Numbers; // ten a pose
};

#endif
