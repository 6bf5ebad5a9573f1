#ifndef vtkSonoFlatText_h
#define vtkSonoFlatText_h

#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

/**
 * @class vtkSonoFlatText
 * @brief What a scanner writes beside its image, of the image's own data
 *
 * Takes an image of vtkSonoUltrasound or vtkSonoScanConverter, flat or not. The output has one row and the column
 * "Text", whose lines say the probe (the bundled preset with the same array, or else how its lines lie), the frequency
 * that is sent and, of a harmonic picture, the one that is received, depth, gain and dynamic range, pictures per second
 * of a scanner that sends one line after the other, c / (2 depth lines), and how many paths each line got, with the
 * error that was reached where one was asked for. What the image does not carry is left out. It never says anything of
 * a patient.
 */
class VTKSONOFILTERS_EXPORT vtkSonoFlatText : public vtkTableAlgorithm
{
public:
  static vtkSonoFlatText* New();
  vtkTypeMacro(vtkSonoFlatText, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSonoFlatText();
  ~vtkSonoFlatText() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoFlatText(const vtkSonoFlatText&) = delete;
  void operator=(const vtkSonoFlatText&) = delete;
};

#endif
