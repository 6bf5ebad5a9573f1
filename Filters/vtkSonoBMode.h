#ifndef vtkSonoBMode_h
#define vtkSonoBMode_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <utility>
#include <vector>

namespace sono {
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

  ///@{
  /**
   * Gain that grows with depth in dB/cm, -100 to 100. Default 5.
   */
  vtkSetMacro(TgcDbPerCm, double);
  vtkGetMacro(TgcDbPerCm, double);
  ///@}

  ///@{
  /**
   * Points (depth in mm, gain in dB) of a curve that is added to the slope, by ascending depth; straight between
   * points, constant beyond the ends. Default none.
   */
  void AddTgcPoint(double depthMm, double gainDb);
  void RemoveAllTgcPoints();
  int GetNumberOfTgcPoints() const { return static_cast<int>(this->TgcPoints.size()); }
  ///@}

  ///@{
  /**
   * Gain everywhere in dB, -300 to 300. Default 0.
   */
  vtkSetMacro(GainDb, double);
  vtkGetMacro(GainDb, double);
  ///@}

  ///@{
  /**
   * Take the 99.9th percentile of the depth-gained envelope as the reference. Default on.
   */
  vtkSetMacro(AutomaticReference, bool);
  vtkGetMacro(AutomaticReference, bool);
  vtkBooleanMacro(AutomaticReference, bool);
  ///@}

  ///@{
  /**
   * Envelope that is white, above 0, where the reference is not automatic. Default 1.
   */
  vtkSetMacro(ReferenceAmplitude, double);
  vtkGetMacro(ReferenceAmplitude, double);
  ///@}

  ///@{
  /**
   * Levels shown in dB, above 0 up to 300: the reference is white, this much below it is black. Default 60.
   */
  vtkSetMacro(DynamicRangeDb, double);
  vtkGetMacro(DynamicRangeDb, double);
  ///@}

  ///@{
  /**
   * Levels less than this above the bottom of the range are black too, in dB, from 0 to below the range. Default 0.
   */
  vtkSetMacro(RejectDb, double);
  vtkGetMacro(RejectDb, double);
  ///@}

  enum GreyMaps
  {
    LINEAR = 0,
    SQUARE_ROOT = 1,
    SIGMOID = 2
  };

  ///@{
  /**
   * What turns the compressed level into grey: the level itself, its square root, which lifts weak echoes, or an
   * S-shaped curve with more contrast in the middle. Default LINEAR.
   */
  vtkSetMacro(GreyMap, int);
  vtkGetMacro(GreyMap, int);
  ///@}

  ///@{
  /**
   * Whether the receiver adds noise, before any gain. Default off.
   */
  vtkSetMacro(AddNoise, bool);
  vtkGetMacro(AddNoise, bool);
  vtkBooleanMacro(AddNoise, bool);
  ///@}

  ///@{
  /**
   * RMS of that noise in dB to the echo of a perfect plane reflector, up to 200. Default -80.
   */
  vtkSetMacro(NoiseDb, double);
  vtkGetMacro(NoiseDb, double);
  ///@}

  ///@{
  /**
   * Seed of the noise, at least 0. Default 1.
   */
  vtkSetMacro(NoiseSeed, int);
  vtkGetMacro(NoiseSeed, int);
  ///@}

protected:
  vtkSonoBMode();
  ~vtkSonoBMode() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  sono::BModeSettings Settings() const;

  vtkSonoBMode(const vtkSonoBMode&) = delete;
  void operator=(const vtkSonoBMode&) = delete;

  double TgcDbPerCm = 5.0;
  std::vector<std::pair<double, double>> TgcPoints;
  double GainDb = 0.0;
  bool AutomaticReference = true;
  double ReferenceAmplitude = 1.0;
  double DynamicRangeDb = 60.0;
  double RejectDb = 0.0;
  int GreyMap = LINEAR;
  bool AddNoise = false;
  double NoiseDb = -80.0;
  int NoiseSeed = 1;
};

#endif
