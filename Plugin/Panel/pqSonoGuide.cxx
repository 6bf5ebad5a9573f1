#include "pqSonoGuide.h"

#include "SonoCornerText.h"
#include "SonoGuidance.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <algorithm>
#include <cmath>

namespace {

// Within which a place counts as reached: no more than a short-axis view may be off (docs/views.md).
constexpr double withinMm = 5.0;
constexpr double withinDeg = 5.0;
constexpr double leastMm = 2.0; // of a slide that is worth a line
const QChar across(0x21c5);     // to or from who looks at the picture

/// The side of the patient to which a direction, LPS, points most; `sign` below 0: the opposite direction.
QString sideOf(const double* direction, double sign)
{
  const double* most =
    std::max_element(direction, direction + 3, [](double a, double b) { return std::abs(a) < std::abs(b); });
  const bool isPositive = *most * sign > 0.0;
  switch (most - direction)
  {
    case 0:
      return isPositive ? pqSonoGuide::tr("the patient's left") : pqSonoGuide::tr("the patient's right");
    case 1:
      return isPositive ? pqSonoGuide::tr("the back") : pqSonoGuide::tr("the front");
    default:
      return isPositive ? pqSonoGuide::tr("the head") : pqSonoGuide::tr("the feet");
  }
}

QString row(QChar arrow, const QString& what)
{
  return QString("<br>%1 %2").arg(arrow).arg(what);
}

QString mm(double value)
{
  return QString("%1 mm").arg(std::abs(value), 0, 'f', 0);
}

QString degrees(double value)
{
  return QString("%1%2").arg(std::abs(value), 0, 'f', 0).arg(QChar(0x00b0));
}

/// Whether it shows anything of a filter.
bool shows(pqRenderView* view, vtkSMProxy* ultrasound)
{
  const vtkSMPropertyHelper shown(view->getProxy(), "Representations");
  for (unsigned int i = 0; i < shown.GetNumberOfElements(); ++i)
  {
    if (vtkSMPropertyHelper(shown.GetAsProxy(i), "Input", true).GetAsProxy() == ultrasound &&
        vtkSMPropertyHelper(shown.GetAsProxy(i), "Visibility", true).GetAsInt() == 1)
    {
      return true;
    }
  }
  return false;
}

void write(const QString& words, QWidget* view)
{
  sonoSayInCorner("SonoGuide", Qt::TopLeftCorner, words, "#f0e68c", view);
}

} // namespace

pqSonoGuide::pqSonoGuide(vtkSMProxy* ultrasound, vtkSMProxy* widget, QObject* parent)
  : QObject(parent)
  , Ultrasound(ultrasound)
  , Widget(widget)
{
  this->Soon.setSingleShot(true);
  this->Soon.setInterval(0);
  this->connect(&this->Soon, SIGNAL(timeout()), SLOT(look()));
  pqCoreUtilities::connect(widget, vtkCommand::PropertyModifiedEvent, &this->Soon, SLOT(start()));
}

pqSonoGuide::~pqSonoGuide()
{
  if (pqApplicationCore::instance())
  {
    this->stop();
  }
}

void pqSonoGuide::guideTo(const SonoWindow& goal)
{
  this->Goal = goal;
  this->look();
}

void pqSonoGuide::stop()
{
  if (this->Goal)
  {
    this->Goal.reset();
    for (auto* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>())
    {
      if (view->widget())
      {
        write(QString(), view->widget());
      }
    }
  }
}

void pqSonoGuide::look()
{
  if (!this->Goal)
  {
    return;
  }
  const QString words = this->words();
  for (auto* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>())
  {
    if (view->widget())
    {
      write(shows(view, this->Ultrasound) ? words : QString(), view->widget());
    }
  }
}

/// One line a movement that is still to be made, short enough for the corner that a fan leaves free.
QString pqSonoGuide::words() const
{
  const sono::PoseNumbers at = sonoPoseOf(this->Widget);
  const sono::Guidance way = sono::guidance(at, this->Goal->pose);
  const QString name = QString::fromStdString(this->Goal->sentence).section(QRegExp("[,:]"), 0, 0).toHtmlEscaped();
  if (way.isReached(withinMm, withinDeg))
  {
    return QString("<b style='color:#70e070'>%1</b>").arg(tr("%1 reached").arg(name));
  }
  const double awayMm = std::hypot(way.slideLateralMm, way.slideElevationMm, way.pressMm);
  QString text = QString("<b>%1</b>").arg(tr("%1: %2 away").arg(name, mm(awayMm)));
  const double* axial = at.data() + 3;
  const double* lateral = at.data() + 6;
  const double elevation[] = { axial[1] * lateral[2] - axial[2] * lateral[1],
                               axial[2] * lateral[0] - axial[0] * lateral[2],
                               axial[0] * lateral[1] - axial[1] * lateral[0] };
  const auto isFar = [&](double slideMm) { return awayMm > withinMm && std::abs(slideMm) >= leastMm; };
  const auto sideways = [](double amount) { return QChar(amount > 0.0 ? 0x2192 : 0x2190); };
  if (isFar(way.slideLateralMm))
  {
    text += row(sideways(way.slideLateralMm),
                tr("Slide %1 to %2").arg(mm(way.slideLateralMm), sideOf(lateral, way.slideLateralMm)));
  }
  if (isFar(way.slideElevationMm))
  {
    text +=
      row(across, tr("Slide across %1 to %2").arg(mm(way.slideElevationMm), sideOf(elevation, way.slideElevationMm)));
  }
  // Over a curved skin this part of the way comes by itself with the slides.
  if (isFar(way.pressMm) && !isFar(way.slideLateralMm) && !isFar(way.slideElevationMm))
  {
    text += row(QChar(way.pressMm > 0.0 ? 0x2193 : 0x2191),
                (way.pressMm > 0.0 ? tr("Press %1") : tr("Lift %1")).arg(mm(way.pressMm)));
  }
  if (std::abs(way.rotateDeg) > withinDeg)
  {
    text += row(
      QChar(way.rotateDeg > 0.0 ? 0x21bb : 0x21ba),
      (way.rotateDeg > 0.0 ? tr("Rotate %1 clockwise") : tr("Rotate %1 counterclockwise")).arg(degrees(way.rotateDeg)));
  }
  if (std::abs(way.tiltDeg) > withinDeg)
  {
    text += row(across, tr("Tilt (fan) %1, beam to %2").arg(degrees(way.tiltDeg), sideOf(elevation, way.tiltDeg)));
  }
  if (std::abs(way.rockDeg) > withinDeg)
  {
    text +=
      row(sideways(way.rockDeg), tr("Rock %1, beam to %2").arg(degrees(way.rockDeg), sideOf(lateral, way.rockDeg)));
  }
  return text;
}
