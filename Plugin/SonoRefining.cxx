#include "SonoRefining.h"

#include "SonoKeptDrawing.h"
#include "SonoTell.h"
#include "SonoUltrasoundHere.h"

#include "pqApplicationCore.h"
#include "pqUndoStack.h"
#include "vtkSMSession.h"

namespace {

constexpr int lookMs = 50;

} // namespace

SonoRefining::SonoRefining(vtkSMProxy* source)
  : Source(source)
{
  this->Timer.setSingleShot(true);
  this->Timer.setInterval(lookMs);
  QObject::connect(&this->Timer, &QTimer::timeout, &this->Timer, [this] { this->look(); });
}

void SonoRefining::setProgressive(bool progressive)
{
  sonoTell(this->Source, "SetProgressive", progressive ? 1 : 0);
}

void SonoRefining::begin()
{
  if (sonoUltrasoundHere(this->Source))
  {
    this->setProgressive(true);
    this->Timer.start();
  }
}

void SonoRefining::pause()
{
  this->Timer.stop();
}

void SonoRefining::look()
{
  if (this->Source->GetSession()->GetPendingProgress())
  {
    this->Timer.start();
    return;
  }
  const bool mayGetBetter =
    sonoUltrasoundHere(this->Source)->IsRefining(); // asked first: what ends now has left its picture
  if (sonoUltrasoundHere(this->Source)->HasBetter())
  {
    SCOPED_UNDO_EXCLUDE();
    const SonoKeptDrawing anatomy(this->Source, SonoKept::Anatomy);
    this->Source->MarkModified(this->Source);
    pqApplicationCore::instance()->render();
  }
  if (mayGetBetter)
  {
    this->Timer.start();
    return;
  }
  this->setProgressive(false); // what is applied from now on is waited for
}
