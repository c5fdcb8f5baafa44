// Bad sensors.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/recording.h"
#include "systems/signals/gate_status.h"
#include "tests/fault/link/link_course.h"
#include "tests/fault/link/link_trial.h"
#include "tests/fault/link/spoilt_rig.h"
#include "tests/fault/link/trials.h"
#include "tests/support/shared_memory.h"

namespace flinch::test {
namespace {

/// A robot whose sensors the test can spoil.
class SensorTrial {
 public:
  SensorTrial() : trial_([this](std::uint32_t domain) { serve_spoilt_rig(domain, *spoilt_); }) {}

  Spoilt& spoilt() { return *spoilt_; }
  LinkTrial& link() { return trial_; }

  /// Ends the run in order and reads what it has recorded.
  Recording recording() {
    trial_.commander().interrupt();
    EXPECT_TRUE(trial_.commander().wait(10s).has_value());
    return read_recording(trial_.recording());
  }

 private:
  SharedMemory<Spoilt> spoilt_;
  LinkTrial trial_;
};

/// The first tick with the gate closed after it has been open.
std::optional<std::size_t> closing(const Recording& recording) {
  const std::vector<double> phase = recording.column("gate", "phase");
  for (std::size_t i = 1; i < phase.size(); ++i) {
    if (phase[i] == static_cast<double>(GatePhase::closed) && phase[i - 1] != phase[i]) return i;
  }
  return std::nullopt;
}

}  // namespace

TrialOutcome broken_joints() {
  SensorTrial trial;
  TrialOutcome outcome;
  trial.link().get_moving();
  const BusLog& log = trial.link().at_commander();
  const LogEnd begin(log);
  const std::uint32_t first = log.joints.count;
  trial.spoilt().joints = true;
  MonotonicClock::sleep_until(MonotonicClock::now() + 100ms);
  std::uint32_t broken = first;
  while (broken < log.joints.count && std::isfinite(log.joints[broken].active[0])) ++broken;
  const auto safe = safe_command(log, begin, Time(log.joints[broken - 1].header.sent_ns));
  if (!safe) return ADD_FAILURE() << "the commander goes on", outcome;
  outcome.findings.push_back({"commander: no torque and brakes after the last good reading", *safe});
  return outcome;
}

TrialOutcome broken_currents() {
  SensorTrial trial;
  TrialOutcome outcome;
  trial.link().get_moving();
  trial.spoilt().currents = true;
  MonotonicClock::sleep_until(MonotonicClock::now() + 100ms);
  const Recording recording = trial.recording();
  const auto closed = closing(recording);
  if (!closed) return ADD_FAILURE() << "the gate stays open", outcome;
  EXPECT_EQ(recording.column("gate", "fault")[*closed], static_cast<double>(GateFault::drives_invalid));
  EXPECT_EQ(recording.column("gate", "reaction")[*closed],
            static_cast<double>(GateReaction::controlled_stop));

  const std::vector<double> valid = recording.column("drives", "valid");
  const std::vector<double> acquired = recording.column("drives", "acquired");
  std::size_t last_good = *closed;
  while (last_good > 0 && valid[last_good] == 0.0) --last_good;
  const Time after = Time(recording.time_ns[*closed]) - Time(std::llround(acquired[last_good]));
  outcome.findings.push_back({"commander: controlled stop after the last good reading", {after, 0ms}});
  return outcome;
}

TrialOutcome missing_imu() {
  expect_undisturbed([] {
    SensorTrial trial;
    trial.link().get_moving();
    const BusLog& log = trial.link().at_robot();
    const LogEnd begin(log);
    trial.spoilt().imu = true;
    MonotonicClock::sleep_until(MonotonicClock::now() + 500ms);
    const Course went = course(log, begin, present_commander(log));
    const Recording recording = trial.recording();
    EXPECT_EQ(recording.column("imu", "valid").back(), 0.0);
    return went;
  });
  return {};
}

}  // namespace flinch::test
