#ifndef vtkSonoNeedle_h
#define vtkSonoNeedle_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

/**
 * @class vtkSonoNeedle
 * @brief A needle with a bevelled tip, for the targets of vtkSonoUltrasound and vtkSonoRayTracer
 *
 * A closed surface in the label map's world (LPS mm): a solid cylinder of 24 sides, whose cross-section is the circle's
 * area, from a hub to the tip, ground to a plane there. The field array "Tissue" says what it is made of, and
 * "RodDiameterMm" that it is round and solid, so that it rings.
 */
class VTKSONOFILTERS_EXPORT vtkSonoNeedle : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoNeedle* New();
  vtkTypeMacro(vtkSonoNeedle, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Middle of the shaft's end that the hand holds, and of the tip, in mm. Default (-30, 0, 0) and (0, 0, 30).
   */
  vtkSetVector3Macro(HubMm, double);
  vtkGetVector3Macro(HubMm, double);
  vtkSetVector3Macro(TipMm, double);
  vtkGetVector3Macro(TipMm, double);
  ///@}

  ///@{
  /**
   * Outer diameter of the shaft in mm, 0.1 to 10. Default 0.82, 21 gauge.
   */
  vtkSetMacro(DiameterMm, double);
  vtkGetMacro(DiameterMm, double);
  ///@}

  ///@{
  /**
   * Angle between the bevel's plane and the shaft in degrees, 5 to 90. Default 20; 90 is a blunt end.
   */
  vtkSetMacro(BevelDeg, double);
  vtkGetMacro(BevelDeg, double);
  ///@}

  ///@{
  /**
   * Turn of the bevel about the shaft in degrees. Default 0: the point lies farthest along z, or along x where the
   * shaft is along z.
   */
  vtkSetMacro(RollDeg, double);
  vtkGetMacro(RollDeg, double);
  ///@}

  ///@{
  /**
   * What the needle is made of, a row of the tissue table. Default "metal".
   */
  vtkSetStdStringFromCharMacro(Tissue);
  vtkGetCharFromStdStringMacro(Tissue);
  ///@}

protected:
  vtkSonoNeedle();
  ~vtkSonoNeedle() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoNeedle(const vtkSonoNeedle&) = delete;
  void operator=(const vtkSonoNeedle&) = delete;

  double HubMm[3] = { -30.0, 0.0, 0.0 };
  double TipMm[3] = { 0.0, 0.0, 30.0 };
  double DiameterMm = 0.82;
  double BevelDeg = 20.0;
  double RollDeg = 0.0;
  std::string Tissue = "metal";
};

#endif
