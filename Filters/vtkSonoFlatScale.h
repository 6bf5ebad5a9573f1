#ifndef vtkSonoFlatScale_h
#define vtkSonoFlatScale_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

/**
 * @class vtkSonoFlatScale
 * @brief What a scanner draws beside its image: rulers, a grey bar and the probe's marker
 *
 * Takes whatever carries a probe in its field data: the output of vtkSonoProbeSource, lines or images. The output lies
 * in the frame of the flat image of vtkSonoScanConverter, mm, a hair in front of it as seen with the transducer on
 * top: left of the scanned area a ruler of the depth from the transducer's face, a tick each centimetre, a longer one
 * with its number each five (each centimetre where there are fewer than eight); below the area the same across, from
 * its middle; right of its lower part a bar of the greys from black to white, with the dB of its ends where the input
 * says its dynamic range; right of the face, clear of the fan, a dot on the side of the probe's marker, to which the
 * lateral direction points. The same probe's is drawn once; it has no field data. The cell array "Part" is 0 on the
 * ruler, 1 on the marker, 2 on the lateral ruler and 3 on the grey bar; "Color" is RGB. Of a matrix's volume it is that
 * of the plane in the middle.
 */
class VTKSONOFILTERS_EXPORT vtkSonoFlatScale : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoFlatScale* New();
  vtkTypeMacro(vtkSonoFlatScale, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSonoFlatScale();
  ~vtkSonoFlatScale() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoFlatScale(const vtkSonoFlatScale&) = delete;
  void operator=(const vtkSonoFlatScale&) = delete;

  struct Drawn;
  std::unique_ptr<Drawn> Last;
};

#endif
