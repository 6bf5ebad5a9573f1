#include "SonoPythonRecord.h"

#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkPythonInterpreter.h"

namespace {

/// What ParaView's tracer, of which its states are made too, does for a source: where it is one of ours and the first,
/// two lines that load the plugin stand before it, for a ParaView that has not loaded it by itself. And what the layout
/// sets of a view stays, which ParaView leaves out where its settings have the same. And a state that cannot be written
/// leaves no tracer behind: ParaView would record on, and collect Python's garbage at each of the hundreds of proxies
/// that a deleted view has. Their modules are changed as they are imported, since whoever asks for them earlier would
/// import much of ParaView.
constexpr const char* hook = R"python(
def _sonovdb_record():
    import importlib.abc
    import importlib.util
    import sys

    def plugin_files(session):
        """On the client, and of a remote session on the server."""
        from paraview import servermanager as sm
        plugins = sm.vtkSMProxyManager.GetProxyManager().GetPluginManager()
        sides = [(plugins.GetLocalInformation(), False)]
        if session.IsA("vtkSMSessionClient"):
            sides.append((plugins.GetRemoteInformation(session), True))
        for known, remote in sides:
            for i in range(known.GetNumberOfPlugins()):
                if known.GetPluginName(i) == "SonoVDB" and known.GetPluginFileName(i):
                    yield known.GetPluginFileName(i), remote

    def change_trace(smtrace):
        from paraview import simple
        finalize = smtrace.RegisterPipelineProxy.finalize
        ours = ("MaximumNumberOfPeels", "LODResolution")

        def is_set(prop):
            return prop is not None and not prop.IsValueDefault()

        def load_and_finalize(self):
            output = smtrace.Trace.Output
            proxy = self.Proxy.SMProxy
            if proxy.GetXMLName().startswith("Sono") and not hasattr(output, "loadsSonoVDB"):
                output.loadsSonoVDB = True
                lines = ["    LoadPlugin(%r, remote=%s, ns=globals())" % each for each in plugin_files(proxy.GetSession())]
                if lines:
                    output.append_separated(["# load the plugin, where ParaView has not by itself",
                                             "if 'SimulateUltrasound' not in globals():"] + lines)
                # A state has made all of its views by now, and each new one would overwrite this in the others.
                for view in [view for view in simple.GetViews() if smtrace.Trace.has_accessor(view)]:
                    output.append(["%s.%s = %r" % (smtrace.Trace.get_accessor(view), name, view.GetProperty(name).GetData())
                                   for name in ours if is_set(view.GetProperty(name))])
            finalize(self)

        smtrace.RegisterPipelineProxy.finalize = load_and_finalize
        never = smtrace.ViewProxyFilter.should_never_trace

        def never_but_layout(self, prop):
            return never(self, prop) and not (prop.get_property_name() in ours and is_set(prop.get_object()))

        smtrace.ViewProxyFilter.should_never_trace = never_but_layout

    def end_with_state(smstate):
        get_state = smstate.get_state

        def get_or_end(*options, **named):
            try:
                return get_state(*options, **named)
            except Exception:
                smstate.smtrace.stop_trace()
                raise

        smstate.get_state = get_or_end

    class Finder(importlib.abc.MetaPathFinder):
        def __init__(self, name, change):
            self.name, self.change = name, change

        def find_spec(self, name, path, target=None):
            if name != self.name:
                return None
            sys.meta_path.remove(self)
            spec = importlib.util.find_spec(name)
            execute = spec.loader.exec_module

            def execute_and_change(module):
                execute(module)
                self.change(module)

            spec.loader.exec_module = execute_and_change
            return spec

    for name, change in (("paraview.smtrace", change_trace), ("paraview.smstate", end_with_state)):
        if name in sys.modules:
            change(sys.modules[name])
        else:
            sys.meta_path.insert(0, Finder(name, change))


_sonovdb_record()
del _sonovdb_record
)python";

class WhenPythonRuns : public vtkCommand
{
public:
  static WhenPythonRuns* New() { return new WhenPythonRuns; }
  void Execute(vtkObject*, unsigned long, void*) override { vtkPythonInterpreter::RunSimpleString(hook); }
};

} // namespace

void sonoInstallPythonRecord()
{
  if (vtkPythonInterpreter::IsInitialized())
  {
    vtkPythonInterpreter::RunSimpleString(hook);
    return;
  }
  static vtkNew<vtkPythonInterpreter> python; // it is told while it lives
  vtkNew<WhenPythonRuns> runs;
  python->AddObserver(vtkCommand::EnterEvent, runs);
}
