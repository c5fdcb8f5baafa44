#include "apps/flinch/progress.h"
#include "apps/flinch/printing.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
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
  if (drawn_) clear_line();
}

void Progress::show(double share, double share_before) {
  if (quiet_) return;
  share = std::clamp(share, 0.0, 1.0);
  const std::string left = time_left(seconds_since(started_), share, share_before);
  if (terminal_) {
    draw_bar(share, left);
  } else {
    print_line(share, left);
  }
}

void Progress::draw_bar(double share, const std::string& time_left) {
  constexpr int width = 30;
  if (drawn_ && seconds_since(last_drawn_) < 0.05) return;
  last_drawn_ = steady_clock::now();
  drawn_ = true;
  const int full = static_cast<int>(share * width);
  clear_line();
  print_message("{} [{:#<{}}{:.<{}}] {:3.0f} %  {}", what_, "", full, "", width - full, 100 * share,
                time_left);
  flush_messages();
}

void Progress::print_line(double share, const std::string& time_left) {
  const int quarters = static_cast<int>(share * 4.0);
  if (quarters <= quarters_) return;
  quarters_ = quarters;
  print_message("{}: {} %{}\n", what_, 25 * quarters, time_left.empty() ? "" : ", " + time_left);
}

std::string time_left(double elapsed, double share, double share_before) {
  constexpr double least = 0.01;  // of what is to be done
  const double done = share - share_before, all = 1.0 - share_before;
  if (done <= least * all || share >= 1.0) return "";
  const double seconds = elapsed * (1.0 - share) / done;
  if (seconds < 100.0) return fmt::format("{:.1f} s left", seconds);
  const auto minutes = std::llround(std::min(seconds / 60.0, 1e9));
  if (minutes < 100) return fmt::format("{} min left", minutes);
  return fmt::format("{} h {:02} min left", minutes / 60, minutes % 60);
}

}  // namespace flinch
