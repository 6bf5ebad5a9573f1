#include "Core/LeaveACore.h"

#include <tbb/task_arena.h>

#include <algorithm>

namespace sono {

void leavingACore(const std::function<void()>& work)
{
  tbb::task_arena(std::max(1, tbb::this_task_arena::max_concurrency() - 1)).execute(work);
}

} // namespace sono
