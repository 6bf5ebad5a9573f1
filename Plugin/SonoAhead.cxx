#include "SonoAhead.h"

#include "SonoUltrasoundHere.h"

#include <algorithm>
#include <utility>

namespace {

QVector<double> numbersOf(const SonoAhead::Pose& pose, const char* function)
{
  const auto found = std::find_if(pose.begin(), pose.end(), [&](const auto& part) { return part.first == function; });
  return found == pose.end() ? QVector<double>() : found->second;
}

} // namespace

SonoAhead::SonoAhead(vtkSMProxy* source)
  : Source(source)
{
}

void SonoAhead::restart()
{
  this->Drawn.clear();
  this->Next.clear();
}

void SonoAhead::restart(const Pose& here)
{
  this->restart();
  if (sonoUltrasoundHere(this->Source))
  {
    this->begin(here); // for the surfaces that its lines hear; the picture itself is not shown
  }
}

/// Whether the picture of a pose is computed from now on, or as soon as the one that is under way has been drawn.
bool SonoAhead::begin(const Pose& pose)
{
  const QVector<double> position = numbersOf(pose, "PositionMm");
  const QVector<double> axial = numbersOf(pose, "Axial");
  const QVector<double> lateral = numbersOf(pose, "Lateral");
  return sonoUltrasoundHere(this->Source)->MakeAhead(position.constData(), axial.constData(), lateral.constData());
}

/// Whether another picture is to come, of the probe as it is.
bool SonoAhead::isOther(const Pose& pose) const
{
  return pose != this->Drawn && numbersOf(pose, "DepthMm") == numbersOf(this->Drawn, "DepthMm");
}

SonoAhead::Pose SonoAhead::toDraw(const Pose& now)
{
  if (!sonoUltrasoundHere(this->Source) || this->Drawn.isEmpty()) // nobody is to wait for the first one
  {
    return this->Drawn = now;
  }
  if (this->Next.isEmpty())
  {
    if (!this->isOther(now) || !this->begin(now))
    {
      return this->Drawn = now;
    }
    this->Next = now;
    return {};
  }
  if (!sonoUltrasoundHere(this->Source)->IsAheadReady())
  {
    return {};
  }
  this->Drawn = std::exchange(this->Next, {});
  if (this->isOther(now) && this->begin(now))
  {
    this->Next = now;
  }
  return this->Drawn;
}
