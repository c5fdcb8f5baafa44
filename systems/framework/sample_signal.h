#pragma once

#include <semaphore.h>

#include "systems/framework/time.h"

namespace flinch {

/// Wakes the control thread when there is news. A wake-up is a hint: after it, look whether there is
/// something new, and do not take one for a count of samples. Without locks.
class SampleSignal {
 public:
  SampleSignal();
  ~SampleSignal();
  SampleSignal(const SampleSignal&) = delete;
  SampleSignal& operator=(const SampleSignal&) = delete;

  /// Never blocks; from any thread or signal handler.
  void notify() noexcept;

  /// Blocks until notify() has been called since the last wake-up, or until MonotonicClock::now() reaches
  /// `deadline`; returns whether it has.
  bool wait_until(Time deadline) noexcept;

 private:
  sem_t notified_;
};

}  // namespace flinch
