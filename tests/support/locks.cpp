#include "tests/support/locks.h"

#include <dlfcn.h>
#include <pthread.h>

#include "tests/support/sanitized.h"

namespace {

thread_local std::int64_t count = 0;

}  // namespace

namespace flinch::test {

std::int64_t locks() { return count; }

}  // namespace flinch::test

#ifndef FLINCH_SANITIZED
namespace {

using Lock = int (*)(pthread_mutex_t*);

Lock find_lock() { return reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock")); }

// Found before there are threads, but even earlier if somebody locks before this file is initialised.
Lock real_lock = find_lock();

}  // namespace

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) {
  ++count;
  if (real_lock == nullptr) real_lock = find_lock();
  return real_lock(mutex);
}
#endif
