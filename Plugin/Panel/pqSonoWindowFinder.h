#ifndef pqSonoWindowFinder_h
#define pqSonoWindowFinder_h

#include "SonoWindows.h"

#include <QWidget>

#include <vector>

class QComboBox;
class vtkSMProxy;

/// The part of a probe's panel that looks for places on the skin: from which an organ is seen (a name, a button), or of
/// standard views (another button), and what was found to choose from.
class pqSonoWindowFinder : public QWidget
{
  Q_OBJECT

public:
  /// Of a Simulate Ultrasound.
  pqSonoWindowFinder(vtkSMProxy* ultrasound, QWidget* parent = nullptr);

Q_SIGNALS:
  void chosen(const SonoWindow& window);
  /// What a person should know, one sentence.
  void said(const QString& sentence);

private:
  Q_DISABLE_COPY(pqSonoWindowFinder)

  void find();
  void findViews();
  void offer(SonoWindows found, bool areRanked);
  void choose(int candidate);

  vtkSMProxy* Ultrasound;
  QComboBox* Target;
  QComboBox* Candidate;
  std::vector<SonoWindow> Windows;
};

#endif
