#include "Cuda/RunOnDevice.h"
#include "SameSettings.h"
#include "SonoImagePlacement.h"
#include "SonoImageSettings.h"
#include "SonoUltrasoundStages.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"

#include <utility>

// The pictures of a moving probe that UltrasoundStages makes before they are asked for.

namespace sono {

void UltrasoundStages::prepareMoving()
{
  if (!simulator_->scene() || field_.preview)
  {
    return;
  }
  try
  {
    simulator_->prepareInteractive(makeScanLines(settings_.geometry, field_.pose), settings_.tracing);
  }
  catch (const Error&) // of a probe that is off the body: make() says it
  {
  }
}

bool UltrasoundStages::makeAhead(const double positionMm[3], const double axial[3], const double lateral[3])
{
  if (!latest_ || latest_->settings.echo.pulse || runsOnDevice(latest_->settings.tracing))
  {
    return false;
  }
  try
  {
    const ProbeField field = probe->ProbeAt(positionMm, axial, lateral, true);
    next_ = latest_;
    next_->pose = field.pose;
    next_->settings = imageSettings(field, *tracer, *formation, *bmode, pixelMmOf(field, converter->GetPixelMm()));
    next_->settings.echo.field = latest_->settings.echo.field;
  }
  catch (const Error&) // make() says it
  {
    next_.reset();
    return false;
  }
  if (!ahead_)
  {
    beginNext();
  }
  return true;
}

void UltrasoundStages::beginNext()
{
  if (next_)
  {
    spare_->setScene(simulator_->scene());
    ahead_ = std::make_unique<BackgroundImage>(std::move(spare_), *std::move(next_));
    next_.reset();
  }
}

/// What was made ahead of this image, if it is the one.
void UltrasoundStages::takeAhead(const ImageInput& image, const Progress& progress)
{
  if (!ahead_)
  {
    return;
  }
  const ImageInput& made = ahead_->input();
  if (same(made.pose, image.pose) && same(made.settings.tracing, image.settings.tracing))
  {
    const std::shared_ptr<const Scene> scene = simulator_->scene();
    std::unique_ptr<Simulator> simulator = ahead_->finish(progress);
    spare_ = std::exchange(simulator_, std::move(simulator));
    simulator_->setScene(scene);
  }
  else
  {
    spare_ = ahead_->stop();
  }
  ahead_.reset();
}

} // namespace sono
