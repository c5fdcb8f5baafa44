#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "drivers/dds_station.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/tick_source.h"

namespace flinch {

/// Ticks of a controller in lockstep: each starts when the robot's readings of that tick have come, however
/// long that takes, and is never late. Only how long nobody answers is measured by the wall clock.
class LockstepTicks final : public TickSource {
 public:
  enum class End : std::uint8_t {
    none,         ///< it goes on
    silent,       ///< the robot has not answered for as long as the patience
    gone,         ///< it no longer waits for this program
    interrupted,  ///< somebody did not want to wait for it
  };

  /// `gives_up`: asked every 20 ms while nothing comes. The station must outlive this.
  LockstepTicks(DdsStation& station, Time patience, std::function<bool()> gives_up)
      : station_(station), patience_(patience), gives_up_(std::move(gives_up)) {}

  /// Lets the robot stand at its start, and waits for the readings there. Returns whether it does.
  bool begin() {
    end_ = End::none;
    time_ = Time::zero();
    station_.ask_for_begin();
    return wait_for_answer();
  }

  /// Lets the robot go, so that it waits for the next controller, once it has obeyed the last command; and
  /// waits until it has heard that, at most 0.4 s.
  void let_go() {
    if (!is_over()) wait_for_answer();
    for (int i = 0; i < 20; ++i) {
      station_.ask_for_end();
      if (station_.wait_for_tick(MonotonicClock::now() + until_sent_again) == DdsStation::Answer::gone)
        return;
    }
  }

  /// Time of the simulation: that of the tick that was waited for.
  Time now() override { return time_; }
  Time first_due(Time, Time) override { return time_; }
  void wait(Time due) override {
    time_ = due;
    wait_for_answer();
  }
  bool is_over() const override { return end_ != End::none; }

  /// Why it is over.
  End end() const noexcept { return end_; }

 private:
  static constexpr Time until_sent_again = 20ms;

  bool wait_for_answer() {
    const Time deadline = MonotonicClock::now() + patience_;
    for (Time now = MonotonicClock::now();; now = MonotonicClock::now()) {
      const DdsStation::Answer answer = station_.wait_for_tick(now + until_sent_again);
      if (answer == DdsStation::Answer::ready) return true;
      if (answer == DdsStation::Answer::gone) return over(End::gone);
      if (gives_up_()) return over(End::interrupted);
      if (now > deadline) return over(End::silent);
      station_.send_again();
    }
  }

  bool over(End end) {
    end_ = end;
    return false;
  }

  DdsStation& station_;
  Time patience_;
  std::function<bool()> gives_up_;
  Time time_{};
  End end_ = End::none;
};

}  // namespace flinch
