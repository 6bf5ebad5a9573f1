#ifndef vtkSonoServerStop_h
#define vtkSonoServerStop_h

#include "vtkObject.h"
#include "vtkSonoWidgetsModule.h" // for export macro

class vtkAlgorithm;
class vtkPVSession;

/**
 * @class vtkSonoServerStop
 * @brief Lets a client stop the filters of its server while they work
 *
 * A server of ParaView 5.11 reads nothing while a filter runs. As a proxy this lives on the server, where our filters
 * ask it (SonoInterruption.h) many times a second. It looks ahead into what has arrived on the clients' own connections
 * and was not read yet; no other connection is needed, so that it works wherever the client's does, as through a
 * tunnel. A wish is a message like the client's others, and holds until the server has come to it in its turn. A client
 * that has gone stops its server, too.
 */
class VTKSONOWIDGETS_EXPORT vtkSonoServerStop : public vtkObject
{
public:
  static vtkSonoServerStop* New();
  vtkTypeMacro(vtkSonoServerStop, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * On a client: sends the wish to the server of a session, which is at work. Nothing in a session without a server.
   */
  static void Ask(vtkPVSession* session);

  /**
   * On a server: listens to the clients that are connected, from now on, and sends progress ten times a second, so that
   * they may answer, instead of once. Nothing in another process.
   */
  void Listen();

  /**
   * On a server: whether a filter was stopped and has not made its data since.
   */
  bool Waits(vtkAlgorithm* filter);

protected:
  vtkSonoServerStop();
  ~vtkSonoServerStop() override;

private:
  vtkSonoServerStop(const vtkSonoServerStop&) = delete;
  void operator=(const vtkSonoServerStop&) = delete;
};

#endif
