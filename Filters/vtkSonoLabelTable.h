#ifndef vtkSonoLabelTable_h
#define vtkSonoLabelTable_h

#include "vtkSmartPointer.h"      // for the rows
#include "vtkSonoFiltersModule.h" // for export macro
#include "vtkTableAlgorithm.h"

#include <string>

class vtkStringArray;

/**
 * @class vtkSonoLabelTable
 * @brief The labels of a scene with their tissues and their numbers, as a table
 *
 * Takes a scene of vtkSonoSceneBuilder, or a label map, of which there are no tissues' numbers. The output has one row
 * a label: id, name, red, green, blue (0 to 255), tissue, guess (1 where the tissue is one that a person should look
 * at), and the columns of the tissue table. The tissue editor works with the same as text.
 */
class VTKSONOFILTERS_EXPORT vtkSonoLabelTable : public vtkTableAlgorithm
{
public:
  static vtkSonoLabelTable* New();
  vtkTypeMacro(vtkSonoLabelTable, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * After an update, one text a label and one a tissue of the whole table, the first one with the columns' names;
   * fields are separated by tabs.
   */
  vtkStringArray* GetLabelRows();
  vtkStringArray* GetTissueRows();
  ///@}

  /**
   * What is wrong with a number in a column of the tissue table, one sentence; empty when it will do.
   */
  static std::string Refusal(const std::string& tissue, const std::string& column, double value);

  /**
   * What a column of the tissue table says, a sentence with unit and range; empty for one that is no number.
   */
  static std::string Meaning(const std::string& column);

protected:
  vtkSonoLabelTable();
  ~vtkSonoLabelTable() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoLabelTable(const vtkSonoLabelTable&) = delete;
  void operator=(const vtkSonoLabelTable&) = delete;

  vtkSmartPointer<vtkStringArray> LabelRows;
  vtkSmartPointer<vtkStringArray> TissueRows;
};

#endif
