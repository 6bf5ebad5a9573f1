#ifndef vtkSonoBMode_h
#define vtkSonoBMode_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>

namespace sono {
class Simulator;
struct BModeSettings;
}

/**
 * @class vtkSonoBMode
 * @brief Depth gain and log compression of the envelope
 *
 * Takes the output of vtkSonoImageFormation. The output has the same lines and samples with the point array "BMode",
 * grey from 0 (black) to 1 (white); its field data hold ReferenceAmplitude, the envelope that is white at 0 dB gain.
 */
class VTKSONOFILTERS_EXPORT vtkSonoBMode : public vtkImageAlgorithm
{
public:
  static vtkSonoBMode* New();
  vtkTypeMacro(vtkSonoBMode, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum GreyMaps
  {
    LINEAR = 0,
    SQUARE_ROOT = 1,
    SIGMOID = 2
  };

  ///@{
  /**
   * Units, ranges, defaults and what they do: sono::BModeSettings.
   */
  sonoParameter(GainDb, double);
  sonoParameter(DynamicRangeDb, double);
  sonoParameter(TgcDbPerCm, double);
  sonoParameter(RejectDb, double);
  sonoParameter(GreyMap, int);
  sonoSwitch(AutomaticReference);
  sonoParameter(ReferenceAmplitude, double);
  sonoSwitch(AddNoise);
  sonoParameter(NoiseDb, double);
  sonoParameter(NoiseSeed, int);
  ///@}

  ///@{
  /**
   * Points (depth in mm, gain in dB) of a curve that is added to the slope, by ascending depth; straight between
   * points, constant beyond the ends. Default none.
   */
  void AddTgcPoint(double depthMm, double gainDb);
  void RemoveAllTgcPoints();
  int GetNumberOfTgcPoints() const;
  ///@}

  /**
   * What the stage is asked to do.
   */
  const sono::BModeSettings& Settings() const;

protected:
  vtkSonoBMode();
  ~vtkSonoBMode() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoBMode(const vtkSonoBMode&) = delete;
  void operator=(const vtkSonoBMode&) = delete;

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::unique_ptr<sono::Simulator> Simulator;
};

#endif
