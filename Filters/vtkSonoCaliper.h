#ifndef vtkSonoCaliper_h
#define vtkSonoCaliper_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

/**
 * @class vtkSonoCaliper
 * @brief Measures in a flat image: a distance, an ellipse's area or an angle
 *
 * The points are in the frame of the flat image of vtkSonoScanConverter, mm, x lateral and y depth. The output lies
 * there, a hair in front of the image as seen with the transducer on top: what is measured as lines, crosses at the
 * points, and the value with its unit as letters. The cell array "Color" is RGB; the field arrays "Value" (mm, mm^2 or
 * degrees) and "Text" (as it is drawn) say the value.
 */
class VTKSONOFILTERS_EXPORT vtkSonoCaliper : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoCaliper* New();
  vtkTypeMacro(vtkSonoCaliper, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    Distance = 0, ///< from the first to the second point
    Ellipse,      ///< one axis is from the first to the second point, the other one reaches as far as the third
    Angle         ///< at the first point, between the ways to the second and the third
  };

  ///@{
  /**
   * What is measured. Default Distance.
   */
  vtkSetMacro(Kind, int);
  vtkGetMacro(Kind, int);
  ///@}

  ///@{
  /**
   * The points in mm; z is not used. The third does not count for a distance. Default (-20, 60), (20, 60), (0, 80).
   */
  vtkSetVector3Macro(Point1Mm, double);
  vtkGetVector3Macro(Point1Mm, double);
  vtkSetVector3Macro(Point2Mm, double);
  vtkGetVector3Macro(Point2Mm, double);
  vtkSetVector3Macro(Point3Mm, double);
  vtkGetVector3Macro(Point3Mm, double);
  ///@}

  ///@{
  /**
   * Height of the digits in mm, 0.1 to 100. Default 6.
   */
  vtkSetClampMacro(DigitMm, double, 0.1, 100.0);
  vtkGetMacro(DigitMm, double);
  ///@}

protected:
  vtkSonoCaliper();
  ~vtkSonoCaliper() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoCaliper(const vtkSonoCaliper&) = delete;
  void operator=(const vtkSonoCaliper&) = delete;

  int Kind = Distance;
  double Point1Mm[3] = { -20.0, 60.0, 0.0 };
  double Point2Mm[3] = { 20.0, 60.0, 0.0 };
  double Point3Mm[3] = { 0.0, 80.0, 0.0 };
  double DigitMm = 6.0;
};

#endif
