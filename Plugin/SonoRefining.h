#pragma once

#include <QTimer>

class vtkSMProxy;

/**
 * Shows how the picture of a Simulate Ultrasound with a target error gets better: after the first paths, which Apply
 * waits for, and again after each further round, which the filter traces in the background. It does so where the filter
 * runs in ParaView's own process. Changes nothing that undo or a trace should know of.
 */
class SonoRefining
{
public:
  explicit SonoRefining(vtkSMProxy* source);

  /// From now on. To be called before the picture is made.
  void begin();
  /// Until it begins again: the probe moves.
  void pause();

private:
  Q_DISABLE_COPY(SonoRefining)

  void setProgressive(bool progressive);
  void look();

  vtkSMProxy* Source;
  QTimer Timer; // fires while better pictures may come
};
