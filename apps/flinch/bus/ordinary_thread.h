#pragma once

#include <pthread.h>
#include <sched.h>

namespace flinch {

/// Takes back what the calling thread has of the hurry of the one that made it.
inline void become_ordinary_thread() {
  const sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
}

}  // namespace flinch
