#pragma once

#include "vtkSMSessionProxyManager.h"
#include "vtkWeakPointer.h"

#include <QString>
#include <QStringList>
#include <QVector>

class vtkSMSourceProxy;

/// The labels of a scene and the tissues they may be, as they stand in the tissue editor. Fields are text.
class SonoTissueModel
{
public:
  /// Columns of a label in the editor: its own, then the numbers of its tissue.
  enum Column
  {
    ID,
    NAME,
    COLOR, ///< "#rrggbb"
    TISSUE,
    FIRST_NUMBER
  };

  /// Those of the scene at a port, which is updated when it has to be. False when it has none.
  bool load(vtkSMSourceProxy* scene, unsigned int port);

  int rowCount() const { return labels_.size(); }
  QStringList columns() const;
  QStringList tissueNames() const;
  QString value(int row, int column) const;
  /// Whether the label's tissue is a guess that nobody has changed here. These labels come first.
  bool isGuess(int row) const { return labels_[row].isGuess; }
  /// "thing (soft_tissue), ventricle (water)"; empty when no tissue is a guess.
  QString guesses() const;

  /// Changes a field; a number changes for all labels of that tissue. Returns what is wrong, one sentence, and changes
  /// nothing then.
  QString setValue(int row, int column, const QString& text);

  /// Writes the two tables, in the format of the bundled ones, where the scene is: of a remote server, there. Returns
  /// what is wrong, one sentence.
  QString save(const QString& labelFile, const QString& tissueFile) const;

  /// What it writes.
  QString labelText() const;
  QString tissueText() const;

  /// What a column says, a sentence with its unit; empty for a label's own.
  QString meaning(int column) const;

private:
  const QStringList* tissueNamed(const QString& name) const;
  QString setTissueNumber(const QString& tissue, int column, const QString& text);

  struct Label
  {
    QString id;
    QString name;
    QString color;
    QString tissue;
    bool isGuess;
  };
  vtkWeakPointer<vtkSMSessionProxyManager> manager_; ///< of the scene
  QVector<Label> labels_;
  QStringList tissueColumns_;    ///< tissue, the numbers, source
  QVector<QStringList> tissues_; ///< fields of these columns
};
