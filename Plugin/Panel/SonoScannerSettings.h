#pragma once

#include <QWidget>

#include <functional>

class QGridLayout;
class vtkSMProxy;

/// The rows of the scanner's panel: ParaView's widgets of properties of a Simulate Ultrasound. A property that has no
/// meaning for the scan's kind, as its XML says, is not shown.
class SonoScannerSettings : public QWidget
{
public:
  /// `changed` is called after each change by a person's hand, which waits for Apply then.
  SonoScannerSettings(vtkSMProxy* ultrasound, const std::function<void()>& changed, QWidget* parent);

private:
  void addRow(QGridLayout* grid, vtkSMProxy* ultrasound, const char* name, const char* text,
              const std::function<void()>& changed);
};
