#include "apps/flinch/bus/interrupts.h"

#include <atomic>
#include <csignal>

namespace flinch {
namespace {

std::atomic<int> interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free);

constexpr int noted[] = {SIGINT, SIGTERM, SIGHUP};

void take_note(int) { interrupts.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

Interrupts::Interrupts() {
  interrupts = 0;
  for (const int signal : noted) std::signal(signal, take_note);
  std::signal(SIGPIPE, SIG_IGN);
}

Interrupts::~Interrupts() {
  for (const int signal : noted) std::signal(signal, SIG_DFL);
  std::signal(SIGPIPE, SIG_DFL);
}

int Interrupts::count() noexcept { return interrupts.load(std::memory_order_relaxed); }

}  // namespace flinch
