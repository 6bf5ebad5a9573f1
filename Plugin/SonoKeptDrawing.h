#pragma once

#include <QList>
#include <QPointer>

class pqDataRepresentation;
class vtkSMProxy;

enum class SonoKept
{
  Anatomy, ///< as Simulate Ultrasound passes it on
  Scale    ///< rulers and grey bar on its flat image
};

/**
 * Keeps what is drawn of a Simulate Ultrasound while a setting changes that it does not depend on.
 *
 * ParaView takes it that whatever a filter passes on changes with each of its settings; making millions of triangles
 * ready to be drawn takes longer than the simulation. What the source is marked with while this object lives does not
 * make a representation of what is kept run: it finds in the view what it has given it, by ParaView's cache of what was
 * made for a view. What it is marked with afterwards does.
 */
class SonoKeptDrawing
{
public:
  /// In all views; nothing if the source is no Simulate Ultrasound. To be made before the source changes.
  SonoKeptDrawing(vtkSMProxy* source, SonoKept what);
  ~SonoKeptDrawing();

  bool holds(const pqDataRepresentation* shown) const;
  /// Makes it anew with the next picture; holds nothing from then on, and may be asked again.
  void drop();

private:
  Q_DISABLE_COPY(SonoKeptDrawing)

  QList<QPointer<pqDataRepresentation>> Kept;
  bool IsHolding = true;
};
