#include "SonoRefining.h"

#include "SonoKeptAnatomy.h"
#include "SonoTell.h"

#include "pqApplicationCore.h"
#include "pqUndoStack.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSonoUltrasound.h"

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

/// That is made in this process; null: none.
vtkSonoUltrasound* SonoRefining::filter() const
{
  return dynamic_cast<vtkSonoUltrasound*>(this->Source->GetClientSideObject());
}

void SonoRefining::setProgressive(bool progressive)
{
  sonoTell(this->Source, "SetProgressive", progressive ? 1 : 0);
}

void SonoRefining::begin()
{
  if (this->filter())
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
  const bool mayGetBetter = this->filter()->IsRefining(); // asked first: what ends now has left its picture
  if (this->filter()->HasBetter())
  {
    SCOPED_UNDO_EXCLUDE();
    const SonoKeptAnatomy anatomy(this->Source);
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
