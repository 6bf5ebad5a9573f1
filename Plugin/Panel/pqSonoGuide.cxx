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

// What a standard view that was found may be off its ideal plane (docs/views.md).
constexpr double withinMm = 5.0;
constexpr double withinDeg = 5.0;
constexpr double withinDepthMm = 5.0;

sono::PoseNumbers poseNow(vtkSMProxy* proxy)
{
  sono::PoseNumbers pose{};
  auto number = pose.begin();
  for (const char* name : { "PositionMm", "Axial", "Lateral" })
  {
    const std::vector<double> part = vtkSMPropertyHelper(proxy, name).GetDoubleArray();
    number = std::copy_n(part.begin(), 3, number);
  }
  return pose;
}

/// Of the three numbers from `first` on, the side of the patient to which they point most, LPS.
QString sideOf(const double* way)
{
  const double* most = std::max_element(way, way + 3, [](double a, double b) { return std::abs(a) < std::abs(b); });
  const bool isPositive = *most > 0.0;
  switch (most - way)
  {
    case 0:
      return isPositive ? pqSonoGuide::tr("the patient's left") : pqSonoGuide::tr("the patient's right");
    case 1:
      return isPositive ? pqSonoGuide::tr("the back") : pqSonoGuide::tr("the front");
    default:
      return isPositive ? pqSonoGuide::tr("the head") : pqSonoGuide::tr("the feet");
  }
}

/// A row of the overlay: what is to be done, or a tick where nothing is.
QString row(bool isDone, const QString& name, const QString& arrow, const QString& what)
{
  return isDone ? QString("<tr><td style='color:#70c070'>&#10003;</td><td style='color:#909090'>%1</td></tr>").arg(name)
                : QString("<tr><td>%1&nbsp;</td><td><b>%2</b> %3</td></tr>").arg(arrow, name, what);
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
  pqCoreUtilities::connect(widget, vtkCommand::PropertyModifiedEvent, this, SLOT(look()));
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

QString pqSonoGuide::words() const
{
  const sono::PoseNumbers at = poseNow(this->Widget);
  const sono::Guidance way = sono::guidance(at, this->Goal->pose);
  const QString name = QString::fromStdString(this->Goal->sentence).section(':', 0, 0).toHtmlEscaped();
  const double awayMm = std::hypot(way.slideLateralMm, way.slideElevationMm, way.pressMm);
  const double depthMm = vtkSMPropertyHelper(this->Widget, "DepthMm").GetAsDouble();
  QString text = QString("<b>%1</b>: ").arg(name);
  text += way.isReached(withinMm, withinDeg)
            ? QString("<span style='color:#70e070'><b>%1</b></span>").arg(tr("reached"))
            : tr("%1 away").arg(mm(awayMm));
  text += "<table>";
  const double* axial = at.data() + 3;
  const double* lateral = at.data() + 6;
  const double elevation[] = { axial[1] * lateral[2] - axial[2] * lateral[1],
                               axial[2] * lateral[0] - axial[0] * lateral[2],
                               axial[0] * lateral[1] - axial[1] * lateral[0] };
  const auto along = [](const double* axis, double sign) {
    const double way[] = { std::copysign(1.0, sign) * axis[0], std::copysign(1.0, sign) * axis[1],
                           std::copysign(1.0, sign) * axis[2] };
    return sideOf(way);
  };
  // All within what is allowed together.
  const bool isThere = awayMm <= withinMm;
  constexpr double leastMm = 2.0;
  const auto isNear = [&](double slideMm) { return isThere || std::abs(slideMm) < leastMm; };
  const QString left(QChar(0x2190));
  const QString right(QChar(0x2192));
  text +=
    row(isNear(way.slideLateralMm), tr("Slide along the picture"), way.slideLateralMm > 0.0 ? right : left,
        tr("%1 %2, to %3")
          .arg(mm(way.slideLateralMm), way.slideLateralMm > 0.0 ? tr("towards the marker") : tr("away from the marker"),
               along(lateral, way.slideLateralMm)));
  text += row(isNear(way.slideElevationMm), tr("Slide across it"), QChar(0x21c5),
              tr("%1 to %2").arg(mm(way.slideElevationMm), along(elevation, way.slideElevationMm)));
  // Over a curved skin the rest of the way comes by itself with the slides.
  if (isNear(way.slideLateralMm) && isNear(way.slideElevationMm) && !isThere)
  {
    text += row(false, way.pressMm > 0.0 ? tr("Press") : tr("Lift"), QChar(way.pressMm > 0.0 ? 0x2193 : 0x2191),
                mm(way.pressMm));
  }
  text += row(std::abs(way.rotateDeg) <= withinDeg, tr("Rotate"), QChar(way.rotateDeg > 0.0 ? 0x21bb : 0x21ba),
              tr("%1 %2, seen from the cable")
                .arg(degrees(way.rotateDeg), way.rotateDeg > 0.0 ? tr("clockwise") : tr("counterclockwise")));
  text += row(std::abs(way.tiltDeg) <= withinDeg, tr("Tilt (fan)"), QChar(0x21c5),
              tr("%1, the beam to %2").arg(degrees(way.tiltDeg), along(elevation, way.tiltDeg)));
  text += row(std::abs(way.rockDeg) <= withinDeg, tr("Rock"), way.rockDeg > 0.0 ? right : left,
              tr("%1, the beam %2")
                .arg(degrees(way.rockDeg), way.rockDeg > 0.0 ? tr("towards the marker") : tr("away from the marker")));
  text += "</table>";
  if (this->Goal->depthMm > 0.0 && std::abs(this->Goal->depthMm - depthMm) > withinDepthMm)
  {
    text += tr("Its depth: %1").arg(mm(this->Goal->depthMm));
  }
  return text;
}
