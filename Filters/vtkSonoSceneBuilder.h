#ifndef vtkSonoSceneBuilder_h
#define vtkSonoSceneBuilder_h

#include "SonoParameters.h"
#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>
#include <vector>

namespace sono {
struct LabelVolume;
struct SharedAnatomy;
class TissueTable;
}
class vtkDataArray;

/**
 * @class vtkSonoSceneBuilder
 * @brief Turns a label map into the anatomy that is scanned
 *
 * Takes a label image from any reader (point scalars that are whole numbers from 0 to 65535) and gives every label a
 * tissue by its name. The output holds one block a label, named after it, with its surface; its field data carry the
 * scene itself, for the ray tracer, and the label table with the tissues that were found. What has label 0 inside the
 * body is filled first where the map has no skin (FillBody), and surfaces that were built before may come from a folder
 * (CacheFolder).
 */
class VTKSONOFILTERS_EXPORT vtkSonoSceneBuilder : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkSonoSceneBuilder* New();
  vtkTypeMacro(vtkSonoSceneBuilder, vtkMultiBlockDataSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Acoustic properties by tissue (CSV); where it is empty, the bundled table. Default empty.
   */
  vtkSetStdStringFromCharMacro(TissueTableFile);
  vtkGetCharFromStdStringMacro(TissueTableFile);
  ///@}

  ///@{
  /**
   * Tissues by label name (CSV with columns pattern, tissue and perhaps guess and code); where it is empty, the bundled
   * one. Default empty.
   */
  vtkSetStdStringFromCharMacro(LabelTissueFile);
  vtkGetCharFromStdStringMacro(LabelTissueFile);
  ///@}

  ///@{
  /**
   * Names, colours and tissues of the labels by number (CSV with columns id, name, r, g, b, tissue), instead of those
   * that the label map brings along and that their names stand for; where it is empty, nothing changes. Default empty.
   */
  vtkSetStdStringFromCharMacro(LabelTableFile);
  vtkGetCharFromStdStringMacro(LabelTableFile);
  ///@}

  ///@{
  /**
   * The text of a tissue table and of a label table (CSV), in place of the files: what the tissue editor tries without
   * saving it. Default empty, where the files count.
   */
  vtkSetStdStringFromCharMacro(TissueTableText);
  vtkGetCharFromStdStringMacro(TissueTableText);
  vtkSetStdStringFromCharMacro(LabelTableText);
  vtkGetCharFromStdStringMacro(LabelTableText);
  ///@}

  ///@{
  /**
   * Tissue of the labels that no pattern matches. A warning names them, and those of which the table only guesses what
   * they are. Default soft_tissue.
   */
  vtkSetStdStringFromCharMacro(FallbackTissue);
  vtkGetCharFromStdStringMacro(FallbackTissue);
  ///@}

  ///@{
  /**
   * Tissue that surrounds the body and counts as acoustic coupling between it and the transducer. Default air.
   */
  vtkSetStdStringFromCharMacro(OutsideTissue);
  vtkGetCharFromStdStringMacro(OutsideTissue);
  ///@}

  enum FillBodyModes
  {
    FILL_OFF = 0,
    FILL_ON = 1,
    FILL_AUTO = 2
  };

  ///@{
  /**
   * Whether label 0 inside the body becomes skin and soft tissue, for label maps whose 0 means both the air outside and
   * tissue without a label. The label map does not show where the skin is: ClosingMm and WallMm estimate it. FILL_AUTO
   * does so, with a warning, where organs, bones or muscles lie bare, and puts a bath of tissue around a bare organ
   * (sono::bodyEnd). Default FILL_AUTO.
   */
  vtkSetClampMacro(FillBody, int, FILL_OFF, FILL_AUTO);
  vtkGetMacro(FillBody, int);
  ///@}

  ///@{
  /**
   * Where the body that is filled ends. Units, ranges, defaults and what they do: sono::BodyFillSettings.
   */
  sonoParameter(ClosingMm, double);
  sonoParameter(WallMm, double);
  sonoParameter(SkinMm, double);
  ///@}

  ///@{
  /**
   * Folder that keeps what was computed, so that it is there at once the next time: built surfaces by the label map's
   * voxels and placement (hundreds of megabytes, used with BuildSurfaces), and of vtkSonoUltrasound the pictures by the
   * content of the files and all settings (a megabyte each). "auto" keeps pictures, and no surfaces, in the user's
   * cache folder (sono::userCacheFolder); empty keeps nothing. What was not used for longest goes when there are more
   * than four gigabytes. Its files may be deleted at any time. Default auto.
   */
  vtkSetStdStringFromCharMacro(CacheFolder);
  vtkGetCharFromStdStringMacro(CacheFolder);
  ///@}

  /**
   * Removes all that was kept in the folder, of this anatomy and of others.
   */
  void ClearCache();

  ///@{
  /**
   * What phases of a motion that were played may take in this process, in megabytes: their label maps, anatomies,
   * surfaces and pictures are kept for the next play while their filters live. What was not used for longest goes
   * first, and so it does while the machine has less than a tenth of its memory left. Default: a quarter of the
   * machine's memory, 4295 at most. 0 keeps none.
   */
  static void LimitKeptPhasesMegabytes(double megabytes);
  static double GetKeptPhasesMegabytes();
  ///@}

  /**
   * What they take now, megabytes.
   */
  static double GetPhasesMegabytesNow();

  /**
   * How many anatomies this filter has built, others' and kept ones not among them.
   */
  vtkGetMacro(BuiltAnatomies, int);

  /**
   * Of all settings that the anatomy depends on, and of the tables that they name. Empty where one cannot be read.
   */
  std::string SettingsKey();

  ///@{
  /**
   * Whether to build the labels' surfaces; without them the output shows the label map's box. The echoes do not
   * depend on it. Default on.
   */
  vtkSetMacro(BuildSurfaces, bool);
  vtkGetMacro(BuildSurfaces, bool);
  vtkBooleanMacro(BuildSurfaces, bool);
  ///@}

protected:
  vtkSonoSceneBuilder();
  ~vtkSonoSceneBuilder() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoSceneBuilder(const vtkSonoSceneBuilder&) = delete;
  void operator=(const vtkSonoSceneBuilder&) = delete;

  sono::TissueTable ReadTissues() const;
  sono::LabelVolume ReadLabels(vtkInformationVector** input);
  void AssignTissues(const sono::TissueTable& table, sono::LabelVolume& volume);
  sono::SharedAnatomy Build(vtkInformationVector** input, bool cached);
  void Warn(const std::string& sentence);

  std::string TissueTableFile;
  std::string LabelTissueFile;
  std::string LabelTableFile;
  std::string TissueTableText;
  std::string LabelTableText;
  std::string FallbackTissue = "soft_tissue";
  std::string OutsideTissue = "air";
  std::unique_ptr<sono::ParameterSet> Parameters;
  int FillBody = FILL_AUTO;
  std::string CacheFolder = "auto";
  bool BuildSurfaces = true;
  int BuiltAnatomies = 0;
  std::vector<std::string> Warnings; // of the anatomy that is being built
};

#endif
