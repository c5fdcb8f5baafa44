#include "experiments/live_view/simulation_pace.h"

#include <charconv>

#include "systems/framework/monotonic_clock.h"

namespace flinch {
namespace {

constexpr Time forgiven = 50ms;  // later than that, the time lost is not made up for

/// None where it is no number.
std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

/// Of the wall clock; not above 0: it is due.
Time SimulationPace::time_until(Time next) {
  const Time now = MonotonicClock::now();
  if (!anchor_) anchor_ = Anchor{now, next};
  const Time wall = anchor_->wall + from_seconds(to_seconds(next - anchor_->simulated) / state_.speed);
  if (now > wall + forgiven) anchor_ = Anchor{now, next};
  return wall - now;
}

void SimulationPace::wait_until(Time next) {
  std::unique_lock lock(mutex_);
  while (!released_) {
    if (state_.paused) {
      if (ticks_allowed_ > 0) {
        --ticks_allowed_;
        return;
      }
      changed_.wait(lock);
    } else if (const Time wait = time_until(next); wait > Time::zero()) {
      changed_.wait_for(lock, wait);
    } else {
      return;
    }
  }
}

void SimulationPace::set(PaceState state) {
  const std::scoped_lock lock(mutex_);
  state_ = state;
  ticks_allowed_ = 0;
  anchor_.reset();
  changed_.notify_all();
}

bool SimulationPace::follow(std::string_view order) {
  constexpr std::string_view speed = "speed ";
  PaceState wanted = state();
  if (order == "tick") {
    const std::scoped_lock lock(mutex_);
    ticks_allowed_ = state_.paused ? ticks_allowed_ + 1 : 0;
    state_.paused = true;
    anchor_.reset();
    changed_.notify_all();
    return true;
  }
  if (order.starts_with(speed)) {
    const std::optional<double> value = number_in(order.substr(speed.size()));
    if (!value || !(*value >= slowest && *value <= fastest)) return false;
    wanted.speed = *value;
  } else if (order == "pause" || order == "go") {
    wanted.paused = order == "pause";
  } else {
    return false;
  }
  set(wanted);
  return true;
}

PaceState SimulationPace::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

void SimulationPace::release() {
  const std::scoped_lock lock(mutex_);
  released_ = true;
  changed_.notify_all();
}

}  // namespace flinch
