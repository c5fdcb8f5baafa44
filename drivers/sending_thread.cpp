#include "drivers/sending_thread.h"

#include <pthread.h>

#include <cstring>
#include <string>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {

SendingThread::SendingThread(std::function<void()> work, int priority) : work_(std::move(work)) {
  thread_ = std::thread(&SendingThread::run, this);
  if (priority == 0) return;
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters);
  if (error == 0) return;
  end();
  throw SetupError("the real-time priority " + std::to_string(priority) +
                   " is not permitted: " + std::strerror(error));
}

SendingThread::~SendingThread() { end(); }

void SendingThread::end() noexcept {
  ending_ = true;
  wake();
  thread_.join();
}

void SendingThread::run() {
  while (!ending_) {
    if (woken_.wait_until(MonotonicClock::now() + 1h)) work_();
  }
  work_();  // it may have been woken while it worked
}

}  // namespace flinch
