#ifndef vtkSonoProbeRepresentation_h
#define vtkSonoProbeRepresentation_h

#include "vtkNew.h"
#include "vtkSonoWidgetsModule.h" // for export macro
#include "vtkWidgetRepresentation.h"

#include <memory>
#include <string>

class vtkSonoSkin;
struct SonoProbePose;

/**
 * @class vtkSonoProbeRepresentation
 * @brief What vtkSonoProbeWidget shows and moves: a transducer, its fan, and handles
 *
 * The fan is the outline of a vtkSonoProbeSource with the same numbers, so that it is the area which is simulated.
 * World coordinates are mm. Movements keep Axial and Lateral unit vectors at right angles; what is set is kept as it is
 * until then.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoProbeRepresentation : public vtkWidgetRepresentation
{
public:
  static vtkSonoProbeRepresentation* New();
  vtkTypeMacro(vtkSonoProbeRepresentation, vtkWidgetRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The pose, as vtkSonoProbeSource describes and defaults it.
   */
  vtkSetVector3Macro(PositionMm, double);
  vtkGetVector3Macro(PositionMm, double);
  vtkSetVector3Macro(Axial, double);
  vtkGetVector3Macro(Axial, double);
  vtkSetVector3Macro(Lateral, double);
  vtkGetVector3Macro(Lateral, double);
  ///@}

  ///@{
  /**
   * The layout of the scan lines, as vtkSonoProbeSource describes and defaults it, by its names. A preset that cannot
   * be read in this process is drawn with the numbers instead.
   */
  void SetPresetFile(const char* path);
  const char* GetPresetFile();
  void SetNumber(const char* name, double value);
  void SetDepthMm(double depth);
  double GetDepthMm();
  ///@}

  /**
   * What the probe can be put on.
   */
  vtkSonoSkin* GetSkin();

  ///@{
  /**
   * Turns the probe about the middle of its face by degrees: about its axis (the lateral direction moves towards the
   * elevation), out of the image plane (the axis moves towards the elevation = axial x lateral), in the image plane
   * (the axis moves towards the lateral direction).
   */
  void Rotate(double degrees);
  void Tilt(double degrees);
  void Rock(double degrees);
  ///@}

  /**
   * Depth of the image in mm more; it stays between 1 and 1000. Nothing happens with a preset, which has its own.
   */
  void ChangeDepth(double mm);

  /**
   * Walks along the skin by mm in the lateral and the elevational direction, keeping the angles to it. Where it leads
   * off the skin, the probe stays, the message says so, and the result is false.
   */
  bool Walk(double lateralMm, double elevationMm);

  /**
   * Puts the middle of the face on a place of the skin with this outward unit normal. The angles to the skin are kept
   * where the probe stood on it before; else the axis becomes the inward normal. Nothing twists about the axis.
   */
  void StandOn(const double place[3], const double outward[3]);

  /**
   * Puts the face on the skin where the axis, from outside, first meets it, or on the nearest place where it never
   * does, and looks straight in. False, with a message, where there is no skin.
   */
  bool SnapToSkin();

  /**
   * One sentence about the last movement; empty when there is nothing to say, and once a number of the scan lines is
   * set otherwise.
   */
  vtkGetCharFromStdStringMacro(Message);
  /**
   * The same as it is drawn in a view of this width in pixels: in lines that are not cut off.
   */
  std::string GetMessageLines(int widthPixels);

  enum InteractionStates
  {
    OUTSIDE = 0,
    SLIDING,
    ROTATING,
    TILTING,
    ROCKING,
    DEEPENING
  };

  /**
   * The state that a press at a display position leads to: a handle's, SLIDING on the transducer itself, or OUTSIDE.
   */
  int ComputeInteractionState(int x, int y, int modify = 0) override;

  /**
   * Where a state's handle is, in the world; the middle of the transducer when sliding.
   */
  void GetHandle(int state, double world[3]);

  void StartWidgetInteraction(double eventPosition[2]) override;
  void WidgetInteraction(double eventPosition[2]) override;
  void EndWidgetInteraction(double eventPosition[2]) override;
  void Highlight(int on) override;
  void BuildRepresentation() override;
  double* GetBounds() VTK_SIZEHINT(6) override;
  void GetActors(vtkPropCollection* actors) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;
  int RenderOpaqueGeometry(vtkViewport* viewport) override;
  int RenderOverlay(vtkViewport* viewport) override;

protected:
  vtkSonoProbeRepresentation();
  ~vtkSonoProbeRepresentation() override;

private:
  vtkSonoProbeRepresentation(const vtkSonoProbeRepresentation&) = delete;
  void operator=(const vtkSonoProbeRepresentation&) = delete;

  SonoProbePose Pose() const;
  void SetPose(const SonoProbePose& pose);
  void FindSkin();
  void Slide(const double eventPosition[2]);
  void FollowWithHandle(const double eventPosition[2]);

  class Internals;
  const std::unique_ptr<Internals> Parts;
  double PositionMm[3];
  double Axial[3];
  double Lateral[3];
  std::string Message;
};

#endif
