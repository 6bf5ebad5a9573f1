#pragma once

#include <QWidget>

#include <algorithm>

class vtkSMProxy;

/// What a panel has made for a source, of a kind that knows its proxy; null: nothing.
template<class Widget>
Widget* sonoWidgetOf(const QWidget* panel, const vtkSMProxy* source)
{
  const auto widgets = panel->findChildren<Widget*>();
  const auto found =
    std::find_if(widgets.begin(), widgets.end(), [source](const Widget* widget) { return widget->proxy() == source; });
  return found == widgets.end() ? nullptr : *found;
}
