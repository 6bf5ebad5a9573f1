#ifndef vtkSonoBMode_h
#define vtkSonoBMode_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>
#include <vector>

namespace sono {
class Simulator;
struct BModeSettings;
struct ProbeSettings;
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
   * Units, ranges, defaults and what they do: sono::BModeSettings.
   */
  sonoParameter(GainDb, double);
  sonoParameter(DynamicRangeDb, double);
  sonoParameter(TgcDbPerCm, double);
  sonoParameter(RejectDb, double);
  sonoSwitch(AutomaticReference);
  sonoParameter(ReferenceAmplitude, double);
  sonoSwitch(AddNoise);
  sonoParameter(NoiseDb, double);
  sonoSwitch(AddHaze);
  sonoParameter(HazeDb, double);
  sonoParameter(HazeFallDbPerCmMHz, double);
  sonoParameter(HazeVariationDb, double);
  sonoParameter(NoiseSeed, int);
  sonoParameter(AxialSmoothingMm, double);
  sonoParameter(LateralSmoothingLines, double);
  sonoSwitch(SmoothCompressed);
  sonoParameter(Tgc1Db, double);
  sonoParameter(Tgc2Db, double);
  sonoParameter(Tgc3Db, double);
  sonoParameter(Tgc4Db, double);
  sonoParameter(Tgc5Db, double);
  sonoParameter(Tgc6Db, double);
  sonoParameter(Tgc7Db, double);
  sonoParameter(Tgc8Db, double);
  sonoParameter(LateralGain1Db, double);
  sonoParameter(LateralGain2Db, double);
  sonoParameter(LateralGain3Db, double);
  sonoParameter(LateralGain4Db, double);
  sonoParameter(LateralGain5Db, double);
  sonoParameter(LateralGain6Db, double);
  sonoParameter(LateralGain7Db, double);
  sonoParameter(LateralGain8Db, double);
  ///@}

  ///@{
  /**
   * What turns the compressed level into grey, applied last: "Linear", "Square Root", which lifts weak echoes, or
   * "S-Shaped", with more contrast in the middle (the tables in Data/grey_maps). Default "Linear".
   */
  vtkSetStdStringFromCharMacro(GreyMap);
  vtkGetCharFromStdStringMacro(GreyMap);
  ///@}

  ///@{
  /**
   * A table of one's own instead: a CSV file with the columns level (ascending, from 0, the bottom of the range, to 1,
   * white) and grey (0 black to 1 white). Empty, the default: the grey map.
   */
  vtkSetStdStringFromCharMacro(GreyMapFile);
  vtkGetCharFromStdStringMacro(GreyMapFile);
  ///@}

  /**
   * What the stage is asked to do for a probe. Throws Error when the grey map cannot be read.
   */
  sono::BModeSettings Settings(const sono::ProbeSettings& probe) const;

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
  std::string GreyMap = "Linear";
  std::string GreyMapFile;
  mutable std::string GreyTablePath; // that was read last
  mutable std::vector<float> GreyTable;
};

#endif
