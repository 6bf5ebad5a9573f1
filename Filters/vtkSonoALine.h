#ifndef vtkSonoALine_h
#define vtkSonoALine_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

class vtkFieldData;

/**
 * @class vtkSonoALine
 * @brief One scan line as a table, to plot it
 *
 * Takes any image of lines (of vtkSonoImageFormation, vtkSonoRayTracer, vtkSonoBMode). The output has the column "Depth
 * (mm)" and one column for each array with one component; where there is an "Envelope", also "Envelope (dB)" relative
 * to the largest one of all lines, at least -200.
 *
 * Where that line lies is on output 1 flat, in the probe's own frame, mm, as the flat image of
 * vtkSonoScanConverter (a hair in front of it, as seen with the transducer on top), and on output 2 in world
 * coordinates, LPS mm. Their field array "Line" is its number.
 */
class VTKSONOFILTERS_EXPORT vtkSonoALine : public vtkTableAlgorithm
{
public:
  static vtkSonoALine* New();
  vtkTypeMacro(vtkSonoALine, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Number of the scan line, from 0, across the array from its lateral beginning. Beyond the last it is the last.
   * Default 64, the middle of 128.
   */
  vtkSetMacro(Line, int);
  vtkGetMacro(Line, int);
  ///@}

  /**
   * The scan line nearest to a place in the image plane of a probe, whose arrays a field holds: lateral and axial in
   * mm, from the centre of the transducer's face. -1 outside the scanned area, for a matrix, whose lines lie in no
   * plane, and where the field holds no probe.
   */
  static int LineAt(vtkFieldData* probe, double lateralMm, double axialMm);

protected:
  vtkSonoALine();
  ~vtkSonoALine() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoALine(const vtkSonoALine&) = delete;
  void operator=(const vtkSonoALine&) = delete;

  int Line = 64;
};

#endif
