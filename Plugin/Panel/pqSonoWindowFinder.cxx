#include "pqSonoWindowFinder.h"

#include "SonoComboBox.h"

#include "vtkSMSourceProxy.h"

#include <QGridLayout>
#include <QPushButton>
#include <QSignalBlocker>

pqSonoWindowFinder::pqSonoWindowFinder(vtkSMProxy* ultrasound, QWidget* parentObject)
  : QWidget(parentObject)
  , Ultrasound(ultrasound)
  , Target(new SonoComboBox(this))
  , Candidate(new SonoComboBox(this))
{
  this->setObjectName("SonoWindow");
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(4);
  grid->setVerticalSpacing(4);
  this->Target->setObjectName("WindowTarget");
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
  this->Candidate->setToolTip(tr("The best places, at most five, and what the probe sees from each."));
  this->Candidate->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  this->Candidate->setMinimumContentsLength(20);
  this->Candidate->hide();
  grid->addWidget(this->Target, 0, 0);
  grid->addWidget(button, 0, 1);
  grid->addWidget(this->Candidate, 1, 0, 1, 2);
  QObject::connect(button, &QPushButton::clicked, this, [this] { find(); });
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
  {
    const QSignalBlocker quiet(this->Candidate);
    this->Windows = std::move(found.windows);
    this->Candidate->clear();
    for (const SonoWindow& window : this->Windows)
    {
      const QString sentence = QString::fromStdString(window.sentence);
      this->Candidate->addItem(QString("%1. %2").arg(this->Candidate->count() + 1).arg(sentence));
      this->Candidate->setItemData(this->Candidate->count() - 1, sentence, Qt::ToolTipRole);
    }
  }
  this->Candidate->setVisible(!this->Windows.empty());
  if (this->Windows.empty())
  {
    Q_EMIT said(QString::fromStdString(found.refusal));
    return;
  }
  choose(0);
}

void pqSonoWindowFinder::choose(int candidate)
{
  if (candidate >= 0 && candidate < int(this->Windows.size()))
  {
    const SonoWindow& window = this->Windows[std::size_t(candidate)];
    Q_EMIT chosen(window);
    Q_EMIT said(QString::fromStdString(window.sentence));
  }
}
