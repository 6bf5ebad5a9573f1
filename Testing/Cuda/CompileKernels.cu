// Compiles the kernels for the GPU, so that a change that only g++ accepts does not go unnoticed. Nothing is launched.
#include "Kernel/BeamField.h"
#include "Kernel/NanoSpace.h"
#include "Kernel/Scatterer.h"
#include "Kernel/TargetBvh.h"
#include "Kernel/TracePath.h"

namespace {

struct CountingSink
{
  float* total;
  __device__ void segment(const sono::PathSegment& s) { atomicAdd(total, s.length * s.intensity); }
  __device__ void echo(const sono::Vec3f&, float amplitude) { atomicAdd(total, amplitude); }
};

template <class Space>
__device__ void traceOne(const sono::TraceView& view, const Space& space, const sono::TraceLine& line, float* total)
{
  CountingSink sink{ total };
  const sono::LineStart start = sono::startLine(view, space, line, sink);
  if (start.meets)
  {
    sono::tracePath(view, space, line, start, sono::PathKey{ blockIdx.x, 0u, threadIdx.x }, sink);
  }
}

} // namespace

__global__ void traceCells(sono::TraceView view, sono::CellSpace<sono::BvhTargets> space, sono::TraceLine line, float* total)
{
  traceOne(view, space, line, total);
}

__global__ void traceNanoVDB(sono::TraceView view, sono::NanoSpace<sono::NoTargets> space, sono::TraceLine line, float* total)
{
  traceOne(view, space, line, total);
}

__global__ void makeScatterers(std::uint64_t seed, float* presence)
{
  presence[threadIdx.x] = sono::scattererSeed(seed, sono::Vec3i(threadIdx.x, blockIdx.x, 0)).presence;
}
