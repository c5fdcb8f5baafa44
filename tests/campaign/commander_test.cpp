// A commander that is killed, that hangs and goes on, or that is killed and begun anew, again and again in
// mid-motion: the robot's brakes close within 10 ms of its last good command wherever the robot's own loop
// was punctual. Twice each; FLINCH_COMMANDERS in the environment says how often instead.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "systems/framework/monotonic_clock.h"
#include "tests/fault/link/link_latency.h"
#include "tests/fault/link/link_trial.h"
#include "tests/support/machine_monitor.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::BusLog;
using test::Latency;
using test::LinkTrial;
using test::LogEnd;

constexpr Time bound = 10ms;
constexpr Time punctual = 1ms;  // the longest between two ticks of the robot, beyond a tick

int wanted_losses() { return test::wanted("FLINCH_COMMANDERS", 2); }

double ms(Time time) { return 1e3 * to_seconds(time); }

class Commander : public testing::Test {
 protected:
  void SetUp() override {
    trial_.start_robot();
    ASSERT_TRUE(test::wait_until(5s, [&] { return log().status.count > 100; })) << trial_.robot().output();
  }

  const BusLog& log() const { return trial_.at_robot(); }

  /// Whether some commander has got the robot moving; where the machine is busy the first may not.
  bool get_moving() {
    for (int attempt = 0; attempt < 5; ++attempt) {
      trial_.start_commander();
      if (trial_.wait_for_motion()) return true;
      ++too_busy_;
    }
    return false;
  }

  /// Loses the commander in mid-motion, and measures until the brakes are closed.
  template <class Lose>
  void lose(const Lose& how) {
    const LogEnd begin(log());
    how();
    std::optional<Latency> latency;
    EXPECT_TRUE(test::wait_until(2s, [&] {
      return (latency = test::brakes_closed(log(), begin)).has_value();
    })) << "the brakes stay open";
    if (latency) latencies_.push_back(*latency);
  }

  void expect_rest(Time how_long) {
    const std::uint32_t first = log().status.count;
    EXPECT_FALSE(test::wait_until(how_long, [&] { return test::opens_brakes(log(), first); }));
  }

  /// Prints what was measured, and judges it where it was the robot's own.
  void judge(const char* what) {
    std::vector<Time> measured;
    Time latest{}, beyond{};
    for (const Latency& each : latencies_) {
      latest = std::max(latest, each.lateness);
      if (each.lateness <= punctual) {
        measured.push_back(each.value);
      } else {
        beyond = std::max(beyond, each.value - each.lateness);
      }
    }
    std::sort(measured.begin(), measured.end());
    fmt::print("commander {}: {} times, {} of them with a punctual robot", what, latencies_.size(),
               measured.size());
    if (!measured.empty())
      fmt::print(": brakes after {:.2f} ms (median), {:.2f} ms (most)", ms(measured[measured.size() / 2]),
                 ms(measured.back()));
    fmt::print(
        "; the robot's loop was late by {:.2f} ms at most, and braked then after {:.2f} ms beyond that; {} "
        "starts "
        "that the machine was too busy for\n",
        ms(latest), ms(beyond), too_busy_);
    for (const Time value : measured) EXPECT_LE(value, bound);
    if (measured.empty()) GTEST_SKIP() << test::not_measured() << ": the robot was never punctual";
  }

  LinkTrial trial_;
  std::vector<Latency> latencies_;
  int too_busy_ = 0;
};

TEST_F(Commander, ThatIsKilledLeavesTheRobotBraked) {
  for (int i = 0; i < wanted_losses() && get_moving(); ++i) {
    lose([&] { trial_.commander().kill(); });
    expect_rest(100ms);
  }
  judge("killed");
}

TEST_F(Commander, ThatHangsAndGoesOnMovesNothing) {
  for (int i = 0; i < wanted_losses() && get_moving(); ++i) {
    lose([&] { trial_.commander().stop(); });
    trial_.commander().resume();
    expect_rest(300ms);
  }
  judge("hung and resumed");
}

TEST_F(Commander, ThatIsKilledAndBegunAnewIsObeyedAgain) {
  for (int i = 0; i < wanted_losses() && get_moving(); ++i) {
    lose([&] { trial_.commander().kill(); });
    const std::uint32_t before = log().status.count;
    if (!get_moving()) break;
    EXPECT_TRUE(test::opens_brakes(log(), before));
    trial_.commander().kill();
    EXPECT_TRUE(test::wait_until(1s, [&] { return log().status[log().status.count - 1].braked == 1; }));
  }
  judge("restarted");
}

}  // namespace
}  // namespace flinch
