#include "pqSonoWindowFinder.h"

#include "SonoComboBox.h"
#include "pqSonoGuide.h"
#include "pqSonoThumbnails.h"

#include "vtkSMSourceProxy.h"

#include <QCheckBox>
#include <QGridLayout>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStandardItemModel>

pqSonoWindowFinder::pqSonoWindowFinder(vtkSMProxy* ultrasound, vtkSMProxy* widget, QWidget* parentObject)
  : QWidget(parentObject)
  , Ultrasound(ultrasound)
  , Target(new SonoComboBox(this))
  , Candidate(new SonoComboBox(this))
  , IsGuided(new QCheckBox(tr("Guide Me There"), this))
  , Guide(new pqSonoGuide(ultrasound, widget, this))
  , Pictures(new pqSonoThumbnails(ultrasound, this))
{
  this->setObjectName("SonoWindow");
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(4);
  grid->setVerticalSpacing(4);
  this->Target->setObjectName("WindowTarget");
  this->Target->setAccessibleName(tr("What to look for"));
  this->Target->setEditable(true);
  this->Target->setInsertPolicy(QComboBox::NoInsert);
  for (const char* name : { "heart", "liver", "right kidney", "left kidney", "spleen", "gallbladder", "bladder",
                            "aorta", "thyroid", "carotid" })
  {
    this->Target->addItem(name);
  }
  this->Target->setToolTip(tr("What Find Window looks for: an organ, or any label by words of its name. After a search "
                              "the list holds what this label map has."));
  auto* button = new QPushButton(tr("Find Window"), this);
  button->setObjectName("FindWindow");
  button->setToolTip(tr("Puts the probe onto the skin where it sees most of the organ, through the least bone and gas, "
                        "and takes the probe and the depth for it. Where the label map is cut is no skin."));
  this->Candidate->setObjectName("WindowCandidate");
  this->Candidate->setAccessibleName(tr("Places found"));
  this->Candidate->setToolTip(
    tr("The best places, at most five, or the standard views, and what the probe sees from each. Small pictures, of "
       "few lines and paths, come one by one while nothing else is done."));
  this->Candidate->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  this->Candidate->setMinimumContentsLength(12);
  this->Candidate->setIconSize(pqSonoThumbnails::size);
  this->Candidate->hide();
  QObject::connect(this->Pictures, &pqSonoThumbnails::made, this, [this](int place, const QPixmap& picture) {
    if (place < int(this->Windows.size()))
    {
      this->Candidate->setItemIcon(place, QIcon(picture));
    }
  });
  grid->addWidget(this->Target, 0, 0);
  auto* views = new QPushButton(tr("Standard Views"), this);
  views->setObjectName("StandardViews");
  views->setToolTip(
    tr("Looks for the standard views (A4C, A2C, A3C, A5C, PLAX, PSAX, subcostal, upper quadrants) by the "
       "landmarks of the labels; choose one in the list. Those that are not obtainable from this "
       "patient say why."));
  grid->addWidget(button, 0, 1);
  grid->addWidget(views, 1, 0, 1, 2);
  grid->addWidget(this->Candidate, 2, 0, 1, 2);
  this->IsGuided->setObjectName("Guide");
  this->IsGuided->setToolTip(
    tr("The probe stays where it is; the views say how far the chosen place is and which way to slide (mm), rotate, "
       "tilt and rock it (degrees), seen from its cable, until it is reached within 5 mm and 5 degrees. Arrows: "
       "left and right in the picture; up and down together, across it. Off: a choice puts the probe there."));
  this->IsGuided->hide();
  grid->addWidget(this->IsGuided, 3, 0, 1, 2);
  QObject::connect(this->IsGuided, &QCheckBox::toggled, this,
                   [this](bool wanted) { wanted ? choose(this->Candidate->currentIndex()) : this->Guide->stop(); });
  QObject::connect(button, &QPushButton::clicked, this, [this] { find(); });
  QObject::connect(views, &QPushButton::clicked, this, [this] { findViews(); });
  QObject::connect(this->Candidate, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
                   [this](int candidate) { choose(candidate); });
}

void pqSonoWindowFinder::find()
{
  const QString target = this->Target->currentText();
  SonoWindows found =
    sonoFindWindows(vtkSMSourceProxy::SafeDownCast(this->Ultrasound), SonoWindowsOf::Anatomy, target.toStdString());
  if (!found.targets.empty())
  {
    this->Target->clear();
    for (const std::string& name : found.targets)
    {
      this->Target->addItem(QString::fromStdString(name));
    }
    this->Target->setCurrentText(target);
  }
  this->offer(std::move(found), true);
  choose(0);
}

void pqSonoWindowFinder::findViews()
{
  this->offer(sonoFindViews(vtkSMSourceProxy::SafeDownCast(this->Ultrasound)), false);
}

void pqSonoWindowFinder::offer(SonoWindows found, bool areRanked)
{
  const QSignalBlocker quiet(this->Candidate);
  this->Windows = std::move(found.windows);
  this->Candidate->clear();
  const auto add = [this](const QString& text, const std::string& sentence) {
    this->Candidate->addItem(text);
    this->Candidate->setItemData(this->Candidate->count() - 1, QString::fromStdString(sentence), Qt::ToolTipRole);
  };
  for (const SonoWindow& window : this->Windows)
  {
    const QString sentence = QString::fromStdString(window.sentence);
    add(areRanked ? QString("%1. %2").arg(this->Candidate->count() + 1).arg(sentence) : sentence, window.sentence);
  }
  for (const std::string& sentence : found.refused)
  {
    add(QString::fromStdString(sentence), sentence);
    qobject_cast<QStandardItemModel*>(this->Candidate->model())->item(this->Candidate->count() - 1)->setEnabled(false);
  }
  this->Candidate->setCurrentIndex(areRanked ? 0 : -1); // the first is the best; of views a person chooses
  this->Candidate->setVisible(this->Candidate->count() > 0);
  this->IsGuided->setVisible(!this->Windows.empty());
  this->Pictures->begin(this->Windows);
  this->Guide->stop(); // until a place of these is chosen
  if (this->Windows.empty())
  {
    Q_EMIT said(QString::fromStdString(found.refusal));
  }
}

void pqSonoWindowFinder::choose(int candidate)
{
  if (candidate >= 0 && candidate < int(this->Windows.size()))
  {
    const SonoWindow& window = this->Windows[std::size_t(candidate)];
    this->IsGuided->isChecked() ? this->Guide->guideTo(window) : Q_EMIT chosen(window);
    Q_EMIT said(QString::fromStdString(window.sentence));
  }
}
