#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "systems/framework/sample_signal.h"

namespace flinch {

/// A thread that does the same work each time it is woken. Waking it neither blocks nor allocates, so a
/// control loop may; who wakes it faster than it works is not waited for, and the work is done once for
/// several calls.
class SendingThread {
 public:
  /// `priority`: SCHED_FIFO, 1 to 99, or 0 for an ordinary thread. Throws SetupError where it is not
  /// permitted.
  SendingThread(std::function<void()> work, int priority);
  SendingThread(const SendingThread&) = delete;
  SendingThread& operator=(const SendingThread&) = delete;
  /// Works once more, then ends.
  ~SendingThread();

  void wake() noexcept { woken_.notify(); }

 private:
  void run();
  void end() noexcept;

  std::function<void()> work_;
  SampleSignal woken_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace flinch
