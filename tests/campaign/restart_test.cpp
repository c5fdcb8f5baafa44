// Either end is restarted again and again, the commander killed in mid-motion, then the robot: they must
// always find each other again, nothing may move before the drives are enabled, and each run must begin where
// the robot is. 5 times; FLINCH_RESTARTS in the environment says how often instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "drivers/drive_state.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/recording.h"
#include "tests/fault/link/link_latency.h"
#include "tests/fault/link/link_trial.h"
#include "tests/support/machine_monitor.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::BusLog;
using test::LinkTrial;

int wanted_restarts() { return test::wanted("FLINCH_RESTARTS", 5); }

bool is_enabled(const flinch_StatusSample& status) {
  return status.drive_state == static_cast<std::uint8_t>(DriveState::operation_enabled);
}

/// The largest values of all restarts.
struct Worst {
  double still = 0.0;      ///< motion of a drive before the brakes open [rad]
  double current = 0.0;    ///< of a drive before the drives are enabled [A]
  double start = 0.0;      ///< motion of a drive within 20 ms after the brakes have opened [rad]
  double reference = 0.0;  ///< between reference and measured position of the platform, at the start [m]
  double away = 0.0;       ///< of the platform from the base origin in x or y, at the start [m]
  Time found{};            ///< from the start of a program to the first command that is obeyed
  int again = 0;           ///< starts of a commander that the machine was too busy for
};

/// Where the logs end before something is started.
struct Mark {
  explicit Mark(const BusLog& log)
      : status(log.status.count), joints(log.joints.count), drives(log.drives.count) {}
  std::uint32_t status;
  std::uint32_t joints;
  std::uint32_t drives;
  Time begun = MonotonicClock::now();
};

class Restarts : public testing::Test {
 protected:
  const BusLog& log() const { return trial_.at_robot(); }
  std::uint32_t session() const { return log().commands[log().commands.count - 1].header.session; }

  /// Whether the robot obeys somebody, one whose first command comes after `begun`.
  bool obeys_anew(const Mark& mark) const {
    const std::uint32_t count = log().status.count;
    for (std::uint32_t i = mark.status; i < count; ++i) {
      if (log().status[i].commander != 0 && Time(log().status[i].command_sent_ns) > mark.begun) return true;
    }
    return false;
  }

  void expect_to_find_each_other(const Mark& mark) {
    ASSERT_TRUE(test::wait_until(10s, [&] { return obeys_anew(mark); })) << trial_.commander().output();
    worst_.found = std::max(worst_.found, MonotonicClock::now() - mark.begun);
  }

  /// Nothing has moved before the drives were enabled and the brakes opened, and nothing jumps then.
  void expect_gentle_start(const Mark& mark) {
    Time enabled = Time::max();
    Time released = Time::max();
    const std::uint32_t count = log().status.count;
    for (std::uint32_t i = mark.status; i < count; ++i) {
      const flinch_StatusSample& status = log().status[i];
      EXPECT_TRUE(is_enabled(status) || status.braked == 1);
      if (is_enabled(status) && enabled == Time::max()) enabled = Time(status.header.sent_ns);
      if (status.braked == 0 && released == Time::max()) released = Time(status.header.sent_ns);
    }
    EXPECT_LT(enabled, released);
    watch_currents(mark, enabled);
    watch_joints(mark, released);
  }

  void watch_currents(const Mark& mark, Time enabled) {
    const std::uint32_t count = log().drives.count;
    for (std::uint32_t i = mark.drives; i < count && Time(log().drives[i].header.sent_ns) < enabled; ++i) {
      for (int leg = 0; leg < 3; ++leg) {
        worst_.current = std::max(worst_.current, std::abs(log().drives[i].current[leg]));
      }
    }
  }

  /// Only the robot that is there now: the last samples of one that was killed may come after a mark.
  void watch_joints(const Mark& mark, Time released) {
    const std::uint32_t count = log().joints.count;
    std::uint32_t begin = mark.joints;
    ASSERT_LT(begin, count) << "the robot sends nothing";
    const std::uint32_t robot = log().joints[count - 1].header.session;
    while (log().joints[begin].header.session != robot) ++begin;
    const flinch_JointSample& first = log().joints[begin];
    for (std::uint32_t i = begin; i < count; ++i) {
      const Time sent(log().joints[i].header.sent_ns);
      if (sent > released + 20ms) return;
      double& worst = sent < released ? worst_.still : worst_.start;
      for (int leg = 0; leg < 3; ++leg) {
        worst = std::max(worst, std::abs(log().joints[i].active[leg] - first.active[leg]));
      }
    }
  }

  /// A commander that gets the robot moving; another one where the machine was too busy for the first.
  void start_commander() {
    for (int attempt = 0; attempt < 5; ++attempt) {
      const Mark mark(log());
      trial_.start_commander();
      expect_to_find_each_other(mark);
      if (trial_.wait_for_motion()) return expect_gentle_start(mark);
      std::cout << trial_.commander().output();
      ++worst_.again;
      kill_commander();
      if (!goes_on()) return;
    }
    if (test::machine_stall() < test::noticeable_stall) FAIL() << "no run has got going";
    GTEST_SKIP() << test::not_measured() << ": no run has got going";
  }

  void kill_commander() {
    trial_.commander().kill();
    ASSERT_TRUE(test::wait_until(1s, [&] {
      const flinch_StatusSample& last = log().status[log().status.count - 1];
      return last.commander == 0 && last.braked == 1;
    }));
    MonotonicClock::sleep_until(MonotonicClock::now() + 100ms);  // it comes to rest
  }

  /// The robot again, for a commander that goes on: it is found, and stays where it is.
  void restart_robot() {
    trial_.robot().kill();
    MonotonicClock::sleep_until(MonotonicClock::now() + 20ms);
    const std::uint32_t before = session();
    const Mark mark(log());
    trial_.start_robot();
    expect_to_find_each_other(mark);
    EXPECT_EQ(session(), before);
    EXPECT_FALSE(test::wait_until(100ms, [&] { return opens_brakes(log(), mark.status); }));
    watch_joints(mark, Time::max());
  }

  /// Ends the commander in order; its run has begun where the robot was.
  void end_commander() {
    trial_.commander().interrupt();
    ASSERT_TRUE(trial_.commander().wait(10s).has_value()) << trial_.commander().output();
    const Recording recording = read_recording(trial_.recording());
    const std::vector<double> valid = recording.column("reference", "valid");
    const auto first = static_cast<std::size_t>(std::find(valid.begin(), valid.end(), 1.0) - valid.begin());
    ASSERT_LT(first, valid.size());
    for (int i = 0; i < 2; ++i) {
      const double wanted = recording.column("reference", "pose", i)[first];
      const double measured = recording.column("motion", "pose", i)[first];
      ASSERT_TRUE(std::isfinite(wanted) && std::isfinite(measured));
      worst_.reference = std::max(worst_.reference, std::abs(wanted - measured));
      worst_.away = std::max(worst_.away, std::abs(measured));
    }
  }

  static bool goes_on() { return !HasFatalFailure() && !IsSkipped(); }

  LinkTrial trial_;
  Worst worst_;
};

TEST_F(Restarts, OfEitherSideAlwaysReconnectAndNeverMoveTheRobotUnasked) {
  const int restarts = wanted_restarts();
  trial_.start_robot();
  ASSERT_TRUE(test::wait_until(5s, [&] { return log().status.count > 100; }));
  for (int i = 0; i < restarts && goes_on(); ++i) {
    start_commander();
    if (goes_on()) kill_commander();
    if (goes_on()) start_commander();
    if (goes_on()) restart_robot();
    if (goes_on()) end_commander();
  }
  if (!goes_on()) return;
  std::cout << restarts << " restarts of the robot and " << 2 * restarts << " of the commander, "
            << worst_.again << " more where the machine was too busy: found after "
            << 1e3 * to_seconds(worst_.found) << " ms at most; before the brakes opened a drive moved by "
            << worst_.still << " rad and had " << worst_.current
            << " A before it was enabled, within 20 ms it moved by " << worst_.start
            << " rad, the reference began " << 1e3 * worst_.reference
            << " mm from the platform, which was up to " << 1e3 * worst_.away << " mm from the origin"
            << std::endl;
  EXPECT_LT(worst_.still, 1e-3);
  EXPECT_LT(worst_.current, 0.2);
  EXPECT_LT(worst_.start, 5e-3);
  EXPECT_LT(worst_.reference, 1e-3);
  EXPECT_GT(worst_.away, 5e-3) << "a run that begins at home proves nothing";
}

}  // namespace
}  // namespace flinch
