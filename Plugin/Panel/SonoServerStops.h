#pragma once

#include "vtkSmartPointer.h"

#include <functional>
#include <map>

class pqPipelineSource;
class vtkObject;
class vtkSMProxy;
class vtkSMSession;

/**
 * The way from the abort button to filters that work on a server (vtkSonoServerStop). The client waits for its server
 * meanwhile, but hears of its progress, and may answer then.
 */
class SonoServerStops
{
public:
  /// What is asked each time that a server tells of progress: whether to stop.
  explicit SonoServerStops(std::function<bool()> wantsStop);
  ~SonoServerStops();

  /// Has the server of a source, if that is one of ours and there is a server, listen from now on.
  void listenFor(pqPipelineSource* source);
  /// Whether that is one of those.
  bool isOn(pqPipelineSource* source) const;
  /// Whether it was stopped and has not made its data since. Not while a server is at work.
  bool waits(pqPipelineSource* source) const;
  /// A session that ends.
  void forget(vtkSMSession* session);

private:
  SonoServerStops(const SonoServerStops&) = delete;
  void operator=(const SonoServerStops&) = delete;

  struct Server
  {
    vtkSmartPointer<vtkSMProxy> stop;
    vtkSmartPointer<vtkObject> progress; // observed
    unsigned long onProgress = 0;
    unsigned long onEnd = 0;
    bool asked = false; // in this run
  };
  void heard(vtkObject* progress, unsigned long event, void*);

  std::function<bool()> wantsStop_;
  std::map<vtkSMSession*, Server> servers_;
};
