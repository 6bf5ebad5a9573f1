#ifndef vtkSonoColorTable_h
#define vtkSonoColorTable_h

#include "vtkPVDiscretizableColorTransferFunction.h"
#include "vtkSonoWidgetsModule.h" // for export macro

/**
 * @class vtkSonoColorTable
 * @brief ParaView's colour map, with the colours of bytes looked up in a table
 *
 * ParaView's own asks its opacity function at each pixel of an image anew, which takes longer than to make and to draw
 * the image. A byte has 256 values: each gets its colour once, and a pixel is a look-up. What is shown is the same.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoColorTable : public vtkPVDiscretizableColorTransferFunction
{
public:
  static vtkSonoColorTable* New();
  vtkTypeMacro(vtkSonoColorTable, vtkPVDiscretizableColorTransferFunction);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void MapScalarsThroughTable2(void* input, unsigned char* output, int inputDataType, int numberOfValues,
                               int inputIncrement, int outputFormat) override;

protected:
  vtkSonoColorTable() = default;
  ~vtkSonoColorTable() override = default;

private:
  vtkSonoColorTable(const vtkSonoColorTable&) = delete;
  void operator=(const vtkSonoColorTable&) = delete;
};

#endif
