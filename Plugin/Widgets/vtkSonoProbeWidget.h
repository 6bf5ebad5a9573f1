#ifndef vtkSonoProbeWidget_h
#define vtkSonoProbeWidget_h

#include "vtkAbstractWidget.h"
#include "vtkSonoWidgetsModule.h" // for export macro

class vtkSonoProbeRepresentation;

/**
 * @class vtkSonoProbeWidget
 * @brief Moves an ultrasound probe with the mouse and the keys
 *
 * Left button: the transducer slides along the surfaces of the representation's vtkSonoSkin; its handles rotate, tilt,
 * rock and set the depth. The arrow keys walk along the skin by 1 mm (left and right: laterally), with Shift they rock
 * (left, right) and tilt (up, down) by 2 degrees, with Control they rotate (left, right) by 2 degrees and change the
 * depth (up, down) by 5 mm; of a view that has the keys, wherever the pointer is. Each movement, also one by a key, is
 * told by StartInteractionEvent, InteractionEvent and EndInteractionEvent; the first one comes before the surfaces are
 * looked at, so that they can be set by then.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoProbeWidget : public vtkAbstractWidget
{
public:
  static vtkSonoProbeWidget* New();
  vtkTypeMacro(vtkSonoProbeWidget, vtkAbstractWidget);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void SetRepresentation(vtkSonoProbeRepresentation* representation);
  vtkSonoProbeRepresentation* GetProbeRepresentation();
  void CreateDefaultRepresentation() override;
  void SetEnabled(int enabling) override;

protected:
  vtkSonoProbeWidget();
  ~vtkSonoProbeWidget() override;

  void SetCursor(int state) override;

private:
  vtkSonoProbeWidget(const vtkSonoProbeWidget&) = delete;
  void operator=(const vtkSonoProbeWidget&) = delete;

  static void Press(vtkAbstractWidget* widget);
  static void Move(vtkAbstractWidget* widget);
  static void Release(vtkAbstractWidget* widget);
  static void Nudge(vtkAbstractWidget* widget);

  bool Moving = false;
};

#endif
