#ifndef vtkSonoPhasesAhead_h
#define vtkSonoPhasesAhead_h

#include "vtkObject.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory> // for what it does

class vtkAlgorithm;
class vtkSonoUltrasound;

/**
 * @class vtkSonoPhasesAhead
 * @brief Makes the phases of a label map that moves ready in the background, one after another
 *
 * That is each phase's label map, anatomy, surfaces, scatterers and the region that a moving probe needs, so that
 * Simulate Ultrasound then has a picture of it as soon as of a phase that was played before. A second source and a
 * second Simulate Ultrasound, with the settings of those that are shown, make them on a thread of their own, which
 * leaves one core free.
 */
class VTKSONOFILTERS_EXPORT vtkSonoPhasesAhead : public vtkObject
{
public:
  static vtkSonoPhasesAhead* New();
  vtkTypeMacro(vtkSonoPhasesAhead, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Begins, once. The second ones have the settings of the first, are nobody else's from now on and lose their
   * observers; Preview of the second probe should be set. They are connected to each other here.
   */
  void Begin(vtkAlgorithm* source, vtkSonoUltrasound* ultrasound, vtkAlgorithm* secondSource,
             vtkSonoUltrasound* secondUltrasound);

  /**
   * Hands what is ready over to the first ones; to be called by the thread that they run on, before they are to have
   * it. How many phases are ready, from the first on. All of them where there is nothing to wait for any more: it was
   * stopped, the source was changed, or a phase could not be made, which the first ones then meet themselves.
   */
  int TakeReady();

  /**
   * Of the source, when it began.
   */
  int GetNumberOfPhases();

  /**
   * Whether a time lies in a phase that TakeReady() has counted.
   */
  bool IsReady(double time);

  ///@{
  /**
   * Begins no further phase, and does not wait for the end of what is being made.
   */
  void Stop();
  bool HasEnded();
  ///@}

protected:
  vtkSonoPhasesAhead();
  /**
   * Stops, and waits for the end.
   */
  ~vtkSonoPhasesAhead() override;

private:
  vtkSonoPhasesAhead(const vtkSonoPhasesAhead&) = delete;
  void operator=(const vtkSonoPhasesAhead&) = delete;

  struct Work;
  std::unique_ptr<Work> Inside; // null before Begin
};

#endif
