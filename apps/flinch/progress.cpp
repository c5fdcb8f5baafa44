#include "apps/flinch/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace flinch {
namespace {

using std::chrono::duration;
using std::chrono::steady_clock;

double seconds_since(steady_clock::time_point start) {
  return duration<double>(steady_clock::now() - start).count();
}

}  // namespace

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      started_(steady_clock::now()) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::show(double share) {
  if (quiet_) return;
  share = std::clamp(share, 0.0, 1.0);
  if (terminal_) {
    draw_bar(share);
  } else {
    print_line(share);
  }
}

void Progress::draw_bar(double share) {
  constexpr int width = 30;
  if (drawn_ && seconds_since(last_drawn_) < 0.05) return;
  last_drawn_ = steady_clock::now();
  drawn_ = true;
  const int full = static_cast<int>(share * width);
  const double elapsed = seconds_since(started_);
  const double left = share > 0.01 ? elapsed * (1.0 - share) / share : 0.0;
  fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %  {:.1f} s left", what_, "", full, "",
             width - full, 100 * share, left);
  std::fflush(stderr);
}

void Progress::print_line(double share) {
  const int quarters = static_cast<int>(share * 4.0);
  if (quarters <= quarters_) return;
  quarters_ = quarters;
  fmt::print(stderr, "{}: {} %\n", what_, 25 * quarters);
}

}  // namespace flinch
