#include "Core/WhenIdle.h"

#include <pthread.h>
#include <sched.h>

namespace sono {

void runWhenIdle()
{
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none); // where it is refused, it takes its share as before
}

} // namespace sono
