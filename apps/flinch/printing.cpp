#include "apps/flinch/printing.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "systems/foundation/setup_error.h"
#include "systems/foundation/visible_text.h"

namespace flinch {
namespace {

std::atomic<int> first_loss = 0;  // errno of the first result that was lost; 0: none

void note_loss(int reason) {
  int none = 0;
  first_loss.compare_exchange_strong(none, reason == 0 ? EIO : reason);
}

}  // namespace

void print_results(std::string_view text) {
  const std::string shown = visible_text(text);
  errno = 0;
  if (std::fwrite(shown.data(), 1, shown.size(), stdout) < shown.size()) note_loss(errno);
}

void print_messages(std::string_view text) noexcept try {
  const std::string shown = visible_text(text);
  std::fwrite(shown.data(), 1, shown.size(), stderr);
} catch (...) {  // of memory
}

void clear_line() noexcept { std::fputs("\r\x1b[K", stderr); }

void flush_messages() noexcept { std::fflush(stderr); }

void flush_results() {
  errno = 0;
  if (std::fflush(stdout) != 0) note_loss(errno);
}

void require_printed() {
  flush_results();
  const int reason = first_loss.exchange(0);
  if (reason == 0) return;
  throw SetupError("what was to be printed cannot be written: " + std::generic_category().message(reason));
}

}  // namespace flinch
