#include "Trace/SharedPaths.h"

#include "Kernel/NanoSpace.h"
#include "Trace/SharedLines.h"

namespace sono {

bool canSharePaths(const TraceView& view)
{
  return !view.deterministic && view.model == InterfaceModel::Acoustic && view.lobe.sigma > 0.0f &&
         view.maxCollisions > 0;
}

template<class Space>
void traceShared(const Space& space, const TraceSetup& setup, TracedLines& out, const Progress& progress)
{
  traceSharedLines(space, { setup.view, setup.lines, setup.paths, setup.frequencyMHz }, out, progress);
}

template void traceShared(const CellSpace<EmbreeTargets, CellsOnDemand>&, const TraceSetup&, TracedLines&,
                          const Progress&);
template void traceShared(const NanoSpace<EmbreeTargets>&, const TraceSetup&, TracedLines&, const Progress&);

} // namespace sono
