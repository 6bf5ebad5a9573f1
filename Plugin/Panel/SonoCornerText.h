#pragma once

#include <QLabel>
#include <QWidget>

/// Writes into a left corner of a view, where a fan is narrower than its view; a text of another name stands beside it.
/// Its label is made when there is first something to say.
inline void sonoSayInCorner(const char* name, Qt::Corner corner, const QString& words, const char* colour,
                            QWidget* view)
{
  auto* label = view->findChild<QLabel*>(name);
  if (!label && words.isEmpty())
  {
    return;
  }
  if (!label)
  {
    label = new QLabel(view);
    label->setObjectName(name);
    label->setAttribute(Qt::WA_TransparentForMouseEvents);
    label->setStyleSheet(QString("QLabel { color: %1; background: rgba(0, 0, 0, 130); padding: 2px; }").arg(colour));
  }
  if (label->text() != words)
  {
    label->setText(words);
    label->adjustSize();
  }
  label->setVisible(!words.isEmpty());
  label->move(0, corner == Qt::TopLeftCorner ? 0 : view->height() - label->height());
}
