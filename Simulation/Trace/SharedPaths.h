#pragma once

#include "Trace/TraceSetup.h"

namespace sono {

/// Whether lines can share paths at all: the lobe must have a density, and weigh no path differently from another.
bool canSharePaths(const TraceView& view);

/// Traces every line, in groups of neighbours that share their paths (see SharedGroup.h), into `out`, whose arrays have
/// their sizes. Batch by batch the groups begin at another line, so that no two lines stay apart throughout. The result
/// does not depend on the threads.
template<class Space>
void traceShared(const Space& space, const TraceSetup& setup, TracedLines& out, const Progress& progress);

} // namespace sono
