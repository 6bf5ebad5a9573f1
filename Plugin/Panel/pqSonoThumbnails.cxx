#include "pqSonoThumbnails.h"

#include "pqCoreUtilities.h"
#include "pqUndoStack.h"
#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPVDataInformation.h"
#include "vtkPointData.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoUltrasound.h"

#include <QGuiApplication>
#include <QImage>
#include <QPainter>

#include <algorithm>

namespace {

constexpr int pauseBetweenMs = 100;
constexpr int fewLines = 48;
constexpr int fewPaths = 12;
constexpr int fewCollisions = 8;
constexpr int pictureRows = 120;

vtkSmartPointer<vtkSMSourceProxy> makeFilter(vtkSMProxy* like, const char* name)
{
  return vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(like->GetSessionProxyManager()->NewProxy("filters", name)));
}

void setNumber(vtkSMProxy* proxy, const char* name, double value)
{
  vtkSMPropertyHelper(proxy, name).Set(value);
}

/// A flat image, wherever it is, on the client.
vtkSmartPointer<vtkImageData> fetch(vtkSMSourceProxy* filter, unsigned int port)
{
  const auto move = makeFilter(filter, "ClientServerMoveData");
  vtkSMPropertyHelper(move, "Input").Set(filter, port);
  vtkSMPropertyHelper(move, "OutputDataType").Set(VTK_IMAGE_DATA);
  move->UpdateVTKObjects();
  move->UpdatePipeline();
  auto* moved = vtkAlgorithm::SafeDownCast(move->GetClientSideObject());
  return moved ? vtkImageData::SafeDownCast(moved->GetOutputDataObject(0)) : nullptr;
}

QImage greyOf(vtkImageData* flat)
{
  vtkDataArray* grey = flat ? flat->GetPointData()->GetArray("BMode") : nullptr;
  if (!grey)
  {
    return {};
  }
  const int* size = flat->GetDimensions();
  QImage image(size[0], size[1], QImage::Format_Grayscale8);
  for (int y = 0; y < size[1]; ++y)
  {
    uchar* line = image.scanLine(y);
    for (int x = 0; x < size[0]; ++x)
    {
      line[x] = static_cast<uchar>(grey->GetTuple1(vtkIdType(y) * size[0] + x));
    }
  }
  return image;
}

} // namespace

pqSonoThumbnails::pqSonoThumbnails(vtkSMProxy* ultrasound, QObject* parent)
  : QObject(parent)
  , Ultrasound(ultrasound)
{
  this->Idle.setSingleShot(true);
  this->Idle.setInterval(pauseBetweenMs);
  this->connect(&this->Idle, SIGNAL(timeout()), SLOT(makeNext()));
  if (vtkSMProxy* labels = vtkSMPropertyHelper(ultrasound, "Input").GetAsProxy())
  {
    pqCoreUtilities::connect(labels, vtkCommand::UpdateDataEvent, this, SLOT(forget()));
  }
}

void pqSonoThumbnails::begin(const std::vector<SonoWindow>& places)
{
  this->Places = places;
  this->Missing.clear();
  for (int place = 0; place < int(places.size()); ++place)
  {
    const auto kept = this->Kept.find(this->key(places[std::size_t(place)]));
    if (kept != this->Kept.end())
    {
      Q_EMIT this->made(place, kept->second);
    }
    else
    {
      this->Missing.push_back(place);
    }
  }
  this->Idle.start();
}

void pqSonoThumbnails::forget()
{
  this->Kept.clear();
}

/// All that differs between the pictures of an anatomy, but the display.
QString pqSonoThumbnails::key(const SonoWindow& place) const
{
  vtkSMProxy* labels = vtkSMPropertyHelper(this->Ultrasound, "Input").GetAsProxy();
  QString key = QString("%1 %2 %3")
                  .arg(labels ? labels->GetGlobalID() : 0)
                  .arg(QString::fromStdString(place.preset))
                  .arg(place.depthMm);
  for (const double number : place.pose)
  {
    key += QString(" %1").arg(number, 0, 'g', 12);
  }
  for (const char* name :
       { "TissueTableFile", "LabelTissueFile", "LabelTableFile", "TissueTableText", "LabelTableText", "FillBody" })
  {
    key += QString("\n") + vtkSMPropertyHelper(this->Ultrasound, name).GetAsString();
  }
  return key;
}

/// One, unless somebody is at work.
void pqSonoThumbnails::makeNext()
{
  if (this->Missing.empty())
  {
    return;
  }
  const bool isMoving = vtkSMPropertyHelper(this->Ultrasound, "Preview").GetAsInt() == 1;
  if (isMoving || QGuiApplication::mouseButtons() != Qt::NoButton ||
      this->Ultrasound->GetSession()->GetPendingProgress())
  {
    this->Idle.start();
    return;
  }
  const int next = this->Missing.front();
  this->Missing.erase(this->Missing.begin());
  const SonoWindow place = this->Places[std::size_t(next)];
  const QPixmap picture = this->make(place);
  if (!picture.isNull()) // else it was stopped, or there is nothing to see
  {
    this->Kept[this->key(place)] = picture;
    Q_EMIT this->made(next, picture);
  }
  this->Idle.start();
}

QPixmap pqSonoThumbnails::make(const SonoWindow& place) const
{
  SCOPED_UNDO_EXCLUDE(); // nobody wants to undo that something was looked at
  const auto small = makeFilter(this->Ultrasound, "SonoUltrasound");
  small->Copy(this->Ultrasound);
  vtkSMPropertyHelper(small, "Input").Set(this->Ultrasound, vtkSonoUltrasound::ANATOMY);
  vtkSMPropertyHelper(small, "CacheFolder").Set("");
  vtkSMPropertyHelper(small, "PresetFile").Set("");
  for (const auto& [name, value] : sonoPresetNumbers(small->GetSessionProxyManager(), place.preset))
  {
    setNumber(small, name.c_str(), value);
  }
  vtkSMPropertyHelper(small, "PositionMm").Set(place.pose.data(), 3);
  vtkSMPropertyHelper(small, "Axial").Set(place.pose.data() + 3, 3);
  vtkSMPropertyHelper(small, "Lateral").Set(place.pose.data() + 6, 3);
  if (place.depthMm > 0.0)
  {
    setNumber(small, "DepthMm", place.depthMm);
  }
  setNumber(small, "LineCount", fewLines);
  setNumber(small, "PathsPerLine", fewPaths);
  setNumber(small, "TargetErrorDb", 0);
  setNumber(small, "MaxCollisions", fewCollisions);
  setNumber(small, "NumberOfShownPaths", 0);
  setNumber(small, "ErrorMap", 0);
  setNumber(small, "Progressive", 0);
  setNumber(small, "Preview", 1);
  setNumber(small, "PixelMm",
            0.5 * vtkSMPropertyHelper(small, "DepthMm").GetAsDouble() / pictureRows); // twice that on the way
  small->UpdateVTKObjects();
  const QImage grey = greyOf(fetch(small, vtkSonoUltrasound::FLAT_IMAGE));
  if (grey.isNull())
  {
    return {};
  }
  QPixmap picture(size);
  picture.fill(Qt::black);
  const QImage fitted = grey.scaled(size, Qt::KeepAspectRatio, Qt::SmoothTransformation);
  QPainter(&picture).drawImage((size.width() - fitted.width()) / 2, (size.height() - fitted.height()) / 2, fitted);
  return picture;
}
