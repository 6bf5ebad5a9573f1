#ifndef vtkSonoPhantomSource_h
#define vtkSonoPhantomSource_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>
#include <vector>

namespace sono {
struct CalibrationPhantomSettings;
struct LabelVolume;
struct PhantomTarget;
}

/**
 * @class vtkSonoPhantomSource
 * @brief A virtual calibration phantom, or a test object, as a label map
 *
 * Port 0 is the same output as vtkSonoLabelMapReader's. Of the calibration phantom, its field data hold the probe's
 * pose for each of the three views: View1PositionMm (LPS mm), View1Axial and View1Lateral, and so on; of a test object,
 * View1 alone. The probe stands on z = 0 and looks along z.
 *
 * Port 1 holds the calibration phantom's wires as closed surfaces with the field array "Tissue", for the ray tracer's
 * targets. Port 2 holds them as points with the point array "Amplitude", for the scatterers of the image formation: a
 * wire is thinner than a wavelength, so it echoes to every beam that covers it, not only to lines that meet it. Both
 * are empty for the test objects and for wires made of voxels.
 */
class VTKSONOFILTERS_EXPORT vtkSonoPhantomSource : public vtkImageAlgorithm
{
public:
  static vtkSonoPhantomSource* New();
  vtkTypeMacro(vtkSonoPhantomSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum PhantomTypes
  {
    Calibration = 0,
    EnhancementSphere,
    ShadowSphere,
    Rib,
    SpeckleCube,
    Neck
  };

  ///@{
  /**
   * Which phantom. Default Calibration.
   */
  vtkSetMacro(Phantom, int);
  vtkGetMacro(Phantom, int);
  ///@}

  ///@{
  /**
   * Edge of a voxel in mm, 0.1 to 5. Default 0.5.
   */
  vtkSetMacro(SpacingMm, double);
  vtkGetMacro(SpacingMm, double);
  ///@}

  ///@{
  /**
   * Table of the calibration phantom's wires and cylinders (CSV). Empty, the default: the bundled one.
   */
  vtkSetStdStringFromCharMacro(TargetFile);
  vtkGetCharFromStdStringMacro(TargetFile);
  ///@}

  ///@{
  /**
   * Thickness of the calibration phantom along the elevation axis in mm, 1 to 127. Default 30.
   */
  vtkSetMacro(ThicknessMm, double);
  vtkGetMacro(ThicknessMm, double);
  ///@}

  ///@{
  /**
   * Lateral distance of two views of the calibration phantom in mm, 0 to 89. Default 45.
   */
  vtkSetMacro(ViewPitchMm, double);
  vtkGetMacro(ViewPitchMm, double);
  ///@}

  ///@{
  /**
   * Whether the calibration phantom's wires are voxels of the label map. Default off.
   */
  vtkSetMacro(WiresAsVoxels, bool);
  vtkGetMacro(WiresAsVoxels, bool);
  vtkBooleanMacro(WiresAsVoxels, bool);
  ///@}

  ///@{
  /**
   * Echo of a millimetre of wire across the beam's focus, against a perfect reflector, >= 0. Default 0.013, for nylon
   * of 0.1 mm under a P4-2.
   */
  vtkSetMacro(WireEchoPerMm, double);
  vtkGetMacro(WireEchoPerMm, double);
  ///@}

  ///@{
  /**
   * Diameter of a sphere in mm, 1 to 60. Default 20.
   */
  vtkSetMacro(SphereDiameterMm, double);
  vtkGetMacro(SphereDiameterMm, double);
  ///@}

  ///@{
  /**
   * Depth of a sphere's centre in mm, more than its radius and at most 110. Default 40.
   */
  vtkSetMacro(SphereDepthMm, double);
  vtkGetMacro(SphereDepthMm, double);
  ///@}

protected:
  vtkSonoPhantomSource();
  ~vtkSonoPhantomSource() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoPhantomSource(const vtkSonoPhantomSource&) = delete;
  void operator=(const vtkSonoPhantomSource&) = delete;

  sono::CalibrationPhantomSettings CalibrationSettings() const;
  std::vector<sono::PhantomTarget> Targets() const;
  std::shared_ptr<const sono::LabelVolume> MakeVolume() const;

  int Phantom = Calibration;
  double SpacingMm = 0.5;
  std::string TargetFile;
  double ThicknessMm = 30.0;
  double ViewPitchMm = 45.0;
  bool WiresAsVoxels = false;
  double WireEchoPerMm = 0.013;
  double SphereDiameterMm = 20.0;
  double SphereDepthMm = 40.0;
  std::shared_ptr<const sono::LabelVolume> Volume; // from the information pass, which needs its size, to the data pass
};

#endif
