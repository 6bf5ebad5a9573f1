#ifndef vtkSonoProbePresets_h
#define vtkSonoProbePresets_h

#include "vtkSmartPointer.h"      // for the rows
#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

#include <string>

class vtkStringArray;

/**
 * @class vtkSonoProbePresets
 * @brief The probes to choose from, as a table
 *
 * The output has one row a bundled preset, by the name of its file, and one for FileName where that is set. The columns
 * are "Preset" (what vtkSonoProbeSource takes as its PresetFile), "Name", and one for each setting of
 * vtkSonoProbeSource that a preset gives, with that setting's name and unit. The panel of a probe works with the same
 * as text.
 */
class VTKSONOFILTERS_EXPORT vtkSonoProbePresets : public vtkTableAlgorithm
{
public:
  static vtkSonoProbePresets* New();
  vtkTypeMacro(vtkSonoProbePresets, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * A preset (JSON) beside the bundled ones; empty: none. Default empty.
   */
  vtkSetStdStringFromCharMacro(FileName);
  vtkGetCharFromStdStringMacro(FileName);
  ///@}

  /**
   * After an update, the rows as text, the first one with the columns' names; fields are separated by tabs.
   */
  vtkStringArray* GetRows();

  /**
   * What is wrong with FileName, one sentence, which is also an error of the update; empty when nothing is.
   */
  const char* GetRefusal();

protected:
  vtkSonoProbePresets();
  ~vtkSonoProbePresets() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoProbePresets(const vtkSonoProbePresets&) = delete;
  void operator=(const vtkSonoProbePresets&) = delete;

  std::string FileName;
  std::string Refusal;
  vtkSmartPointer<vtkStringArray> Rows;
};

#endif
