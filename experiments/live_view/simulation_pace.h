#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string_view>

#include "systems/framework/time.h"

namespace flinch {

/// How fast a simulation goes beside the clock on the wall, as somebody orders while it runs.
struct PaceState {
  double speed = 1.0;  ///< simulated seconds in a second
  bool paused = false;
  friend bool operator==(const PaceState&, const PaceState&) = default;
};

/// Holds a simulation up between its ticks so that it goes as fast as is wanted. A simulation that cannot
/// keep up goes on from where it is and does not hurry later. One thread waits, any others give orders.
class SimulationPace {
 public:
  static constexpr double slowest = 0.001;
  static constexpr double fastest = 100.0;

  explicit SimulationPace(double speed) { state_.speed = speed; }

  /// Returns when the tick at `next` is due.
  void wait_until(Time next);

  /// Follows "pause", "go", "tick" (one more, and pause) or "speed 0.1". False: it is none of these, or a
  /// speed that is not from `slowest` to `fastest`.
  bool follow(std::string_view order);

  PaceState state() const;
  /// Nothing is waited for from now on.
  void release();

 private:
  /// An instant by both clocks, since which the speed has been the same.
  struct Anchor {
    Time wall;
    Time simulated;
  };
  void set(PaceState state);
  Time time_until(Time next);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  PaceState state_;
  int ticks_allowed_ = 0;  ///< while it is paused
  bool released_ = false;
  std::optional<Anchor> anchor_;  ///< none: the next tick is one
};

}  // namespace flinch
