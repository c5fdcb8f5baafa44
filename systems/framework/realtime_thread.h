#pragma once

#include <sched.h>

#include <string>
#include <vector>

namespace flinch {

/// How much a program insists on something that the machine may refuse.
enum class Requirement {
  none,     ///< do not ask for it
  prefer,   ///< ask, and report whether it was granted
  require,  ///< ask, and do not start without it
};

/// What a control thread asks the machine for.
struct RealtimeSettings {
  Requirement scheduling = Requirement::prefer;
  int priority = 80;  ///< SCHED_FIFO, 1 to 99; threads that the loop waits for should have no lower one
  Requirement locked_memory = Requirement::prefer;
  Requirement affinity = Requirement::none;
  int cpu = 0;  ///< the one processor to run on
  Requirement realtime_kernel = Requirement::prefer;
};

/// One thing that was asked for, and the answer.
struct Privilege {
  std::string name;  ///< "SCHED_FIFO priority 80"
  Requirement insistence = Requirement::none;
  bool granted = false;
  std::string reason;  ///< why it was not granted
  std::string remedy;  ///< how to change that
};

/// What a control thread has, and has not, been granted.
struct RealtimeReport {
  std::vector<Privilege> privileges;  ///< in the order of RealtimeSettings, without what nobody asked for

  bool all_granted() const;
  /// A line for each privilege; for one that was not granted, why, and how to change that.
  std::string text() const;
};

/// Whether a thread of this program may run with SCHED_FIFO and `priority`, 1 to 99.
bool permits_realtime(int priority);

/// The calling thread as a control thread, until destroyed by the same thread. Threads that it starts
/// meanwhile inherit its priority and processor. It runs
/// - SCHED_FIFO: before all ordinary threads, so that a busy machine does not delay it;
/// - with all memory locked that the process has by then, and 256 KiB of stack: no tick waits for a page.
///   It lasts until the process ends. What is allocated later is not locked: make contexts and recorders
///   before;
/// - on one processor, if wanted, best one that the kernel keeps free (isolcpus);
/// - on a kernel that can be preempted everywhere (PREEMPT_RT), which one can only look for.
class RealtimeThread {
 public:
  /// Asks for everything, then throws SetupError with all that was required and not granted.
  explicit RealtimeThread(const RealtimeSettings& settings);
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;
  /// Gives back priority and processor.
  ~RealtimeThread();

  const RealtimeReport& report() const { return report_; }

 private:
  void give_back();

  RealtimeReport report_;
  int policy_ = 0;  // what the thread had before
  sched_param parameters_{};
  cpu_set_t processors_{};
};

}  // namespace flinch
