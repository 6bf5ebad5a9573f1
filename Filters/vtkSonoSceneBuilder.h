#ifndef vtkSonoSceneBuilder_h
#define vtkSonoSceneBuilder_h

#include "vtkMultiBlockDataSetAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <string>

class vtkDataArray;

/**
 * @class vtkSonoSceneBuilder
 * @brief Turns a label map into the anatomy that is scanned
 *
 * Takes a label image from any reader (point scalars that are whole numbers from 0 to 65535) and gives every label a
 * tissue by its name. The output holds one block a label, named after it, with its surface; its field data carry the
 * scene itself, for the ray tracer, and the label table with the tissues that were found.
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
   * Tissues by label name (CSV with columns pattern and tissue); where it is empty, the bundled one. Default empty.
   */
  vtkSetStdStringFromCharMacro(LabelTissueFile);
  vtkGetCharFromStdStringMacro(LabelTissueFile);
  ///@}

  ///@{
  /**
   * Tissue of the labels whose names no pattern matches; a warning names them. Default soft_tissue.
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

  vtkDataArray* LabelArray(vtkInformationVector** input);

  std::string TissueTableFile;
  std::string LabelTissueFile;
  std::string FallbackTissue = "soft_tissue";
  std::string OutsideTissue = "air";
  bool BuildSurfaces = true;
};

#endif
