#pragma once

#include <QComboBox>
#include <QWheelEvent>

/// A combo box that the wheel scrolls past, so that scrolling a panel or a table changes nothing in it.
class SonoComboBox : public QComboBox
{
public:
  using QComboBox::QComboBox;

protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};
