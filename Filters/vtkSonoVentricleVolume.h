#ifndef vtkSonoVentricleVolume_h
#define vtkSonoVentricleVolume_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <array>
#include <string>
#include <vector>

/**
 * @class vtkSonoVentricleVolume
 * @brief A ventricle's volume by Simpson's method of discs from contours in one or two flat images
 *
 * Port 0 takes the flat image of the apical four-chamber view, port 1, optional, that of the two-chamber view. A
 * contour is traced by hand, from one end of the annulus along the wall to the other, or is that of the ventricle's
 * label. The outputs lie in the frames of the two images, mm, x lateral and y depth: contour, long axis, discs and the
 * volume as letters. With both contours the volume is biplane, with one single-plane, with none there is no number.
 * Field arrays of both outputs: "VolumeMl", "FourChamberMl" and "TwoChamberMl" (single-plane), "LengthMm" (the longer
 * axis), "Text" (as it is drawn).
 */
class VTKSONOFILTERS_EXPORT vtkSonoVentricleVolume : public vtkPolyDataAlgorithm
{
public:
  static vtkSonoVentricleVolume* New();
  vtkTypeMacro(vtkSonoVentricleVolume, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Contours
  {
    Traced = 0, ///< the points below
    Labels      ///< the convex hull of the ventricle's label, open at the atrium
  };

  ///@{
  /**
   * Where contours come from. Default Traced.
   */
  vtkSetMacro(Contour, int);
  vtkGetMacro(Contour, int);
  ///@}

  ///@{
  /**
   * Words of the names of ventricle and atrium, all of which are in a label's name; of several such labels those of
   * blood count. Default "left ventricle" and "left atrium".
   */
  vtkSetMacro(Ventricle, std::string);
  vtkGetMacro(Ventricle, std::string);
  vtkSetMacro(Atrium, std::string);
  vtkGetMacro(Atrium, std::string);
  ///@}

  ///@{
  /**
   * Points of the contours, lateral and depth in mm, in order.
   */
  void AddFourChamberPoint(double lateralMm, double depthMm);
  void ClearFourChamberPoints();
  void AddTwoChamberPoint(double lateralMm, double depthMm);
  void ClearTwoChamberPoints();
  ///@}

  ///@{
  /**
   * Number of discs, 1 to 200. Default 20, as recommended.
   */
  vtkSetMacro(Discs, int);
  vtkGetMacro(Discs, int);
  ///@}

  ///@{
  /**
   * Height of the digits in mm, 0.1 to 100. Default 6.
   */
  vtkSetClampMacro(DigitMm, double, 0.1, 100.0);
  vtkGetMacro(DigitMm, double);
  ///@}

protected:
  vtkSonoVentricleVolume();
  ~vtkSonoVentricleVolume() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoVentricleVolume(const vtkSonoVentricleVolume&) = delete;
  void operator=(const vtkSonoVentricleVolume&) = delete;

  int Contour = Traced;
  std::string Ventricle = "left ventricle";
  std::string Atrium = "left atrium";
  std::array<std::vector<std::array<double, 2>>, 2> PointsMm;
  int Discs = 20;
  double DigitMm = 6.0;
};

#endif
