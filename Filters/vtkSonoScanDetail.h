#ifndef vtkSonoScanDetail_h
#define vtkSonoScanDetail_h

#include "SonoParameters.h"
#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

/**
 * @class vtkSonoScanDetail
 * @brief Adds to a label map what the CT or MR that was segmented shows besides
 *
 * Input 0 is the label map, input 1 the scan, each at its own place in the world. The output is the label map with one
 * more point array, "ScanDetail", the level of the backscatter within each label (sono::scanDetail), which
 * vtkSonoSceneBuilder takes up. Of a CT, what has label 0 inside the body becomes skin, fat, muscle, lung, bone and gas
 * (sono::fillFromCt); of an MR it stays 0.
 */
class VTKSONOFILTERS_EXPORT vtkSonoScanDetail : public vtkImageAlgorithm
{
public:
  static vtkSonoScanDetail* New();
  vtkTypeMacro(vtkSonoScanDetail, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The scan.
   */
  void SetScanConnection(vtkAlgorithmOutput* scan) { this->SetInputConnection(1, scan); }

  ///@{
  /**
   * How the scan counts. Units, ranges, defaults and what they do: sono::ScanDetailSettings.
   */
  sonoParameter(DetailDbPer100Hu, double);
  sonoParameter(DetailDirection, int);
  sonoSwitch(FillFromCt);
  sonoParameter(SkinMm, double);
  ///@}

  ///@{
  /**
   * Tissues by label name, as of vtkSonoSceneBuilder; where it is empty, the bundled ones. They tell which values a
   * label should have and where blood is. Default empty.
   */
  vtkSetStdStringFromCharMacro(LabelTissueFile);
  vtkGetCharFromStdStringMacro(LabelTissueFile);
  ///@}

  /**
   * What tells the output, without making it: the inputs' content, the settings and the tables. Empty where that is not
   * known.
   */
  std::string ContentKey();

protected:
  vtkSonoScanDetail();
  ~vtkSonoScanDetail() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoScanDetail(const vtkSonoScanDetail&) = delete;
  void operator=(const vtkSonoScanDetail&) = delete;

  std::unique_ptr<sono::ParameterSet> Parameters;
  std::string LabelTissueFile;
};

#endif
