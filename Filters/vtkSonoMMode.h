#ifndef vtkSonoMMode_h
#define vtkSonoMMode_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <vector>

/**
 * @class vtkSonoMMode
 * @brief One scan line over time
 *
 * Takes B-mode lines (of vtkSonoBMode, or that output of vtkSonoUltrasound) of a label map that has time steps, and
 * asks for all of them. The output is an image with x the time in s and y the depth in mm; its point array "BMode" is
 * 1 (black) to 255, as that of vtkSonoScanConverter. Columns are equidistant, as far apart as the nearest time steps;
 * each shows the last time step that has begun.
 */
class VTKSONOFILTERS_EXPORT vtkSonoMMode : public vtkImageAlgorithm
{
public:
  static vtkSonoMMode* New();
  vtkTypeMacro(vtkSonoMMode, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Number of the scan line, from 0, across the array from its lateral beginning. Beyond the last it is the last.
   * Default 64, the middle of 128.
   */
  vtkSetMacro(Line, int);
  vtkGetMacro(Line, int);
  ///@}

  ///@{
  /**
   * Time from one step to the next in s, for inputs whose times are mere numbers, as those of a file a phase. 0, the
   * default: the times of the input, in s.
   */
  vtkSetMacro(SecondsPerStep, double);
  vtkGetMacro(SecondsPerStep, double);
  ///@}

protected:
  vtkSonoMMode();
  ~vtkSonoMMode() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoMMode(const vtkSonoMMode&) = delete;
  void operator=(const vtkSonoMMode&) = delete;

  void TakeLine(vtkImageData* lines);
  void MakeImage(const std::vector<std::size_t>& shownSteps, vtkImageData* image);

  int Line = 64;
  double SecondsPerStep = 0.0;
  std::vector<double> StepTimes;           // of the input
  std::vector<std::vector<float>> Columns; // of the steps so far
};

#endif
