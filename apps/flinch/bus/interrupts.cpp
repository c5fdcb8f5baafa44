#include "apps/flinch/bus/interrupts.h"

#include <atomic>
#include <csignal>

namespace flinch {
namespace {

std::atomic<int> interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void take_note(int) { interrupts.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

Interrupts::Interrupts() {
  interrupts = 0;
  std::signal(SIGINT, take_note);
  std::signal(SIGTERM, take_note);
}

Interrupts::~Interrupts() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

int Interrupts::count() noexcept { return interrupts.load(std::memory_order_relaxed); }

}  // namespace flinch
