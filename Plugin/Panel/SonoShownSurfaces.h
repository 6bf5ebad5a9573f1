#ifndef SonoShownSurfaces_h
#define SonoShownSurfaces_h

#include "vtkSmartPointer.h"

#include <QMap>
#include <QPair>

class pqView;
class vtkDataObject;
class vtkMultiBlockDataSet;
class vtkSMProxy;

/**
 * The surfaces that a view shows, on the client, whatever server they are on. From a server they come once, with fewer
 * triangles (vtkSonoCoarseSurfaces).
 */
class SonoShownSurfaces
{
public:
  /// Adds a block for each that is visible in `view`; of `probe`, which has a fan and an image of its own, the anatomy
  /// alone.
  void collect(const pqView& view, vtkSMProxy* probe, vtkMultiBlockDataSet* surfaces);
  /// A source that goes away.
  void forget(vtkSMProxy* source);

private:
  struct Surfaces
  {
    vtkSmartPointer<vtkSMProxy> producer; // here, of all; on a server, of fewer triangles
    int version = 0;                      // of what has come from a server
    vtkSmartPointer<vtkDataObject> data;
  };
  vtkDataObject* fetch(vtkSMProxy* source, int port);
  vtkDataObject* fetchCoarse(vtkSMProxy* source, int port);

  QMap<QPair<vtkSMProxy*, int>, Surfaces> Fetched;
};

#endif
