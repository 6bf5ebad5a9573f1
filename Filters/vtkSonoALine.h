#ifndef vtkSonoALine_h
#define vtkSonoALine_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

/**
 * @class vtkSonoALine
 * @brief One scan line as a table, to plot it
 *
 * Takes any image of lines (of vtkSonoImageFormation, vtkSonoRayTracer, vtkSonoBMode). The output has the column "Depth
 * (cm)" and one column for each array with one component; where there is an "Envelope", also "Envelope (dB)" relative
 * to the largest one of all lines, at least -200.
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

protected:
  vtkSonoALine();
  ~vtkSonoALine() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoALine(const vtkSonoALine&) = delete;
  void operator=(const vtkSonoALine&) = delete;

  int Line = 64;
};

#endif
