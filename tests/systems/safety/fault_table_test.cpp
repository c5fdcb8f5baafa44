#include "systems/safety/fault_table.h"

#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "tests/systems/safety/gated_inputs.h"

namespace flinch {
namespace {

using test::Inputs;
using test::Safety;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180.0;

/// What brings a fault about, and what is as bad as it can be without doing so.
struct Cause {
  std::function<void(Inputs&)> fault;
  std::function<void(Inputs&)> just_not = [](Inputs&) {};
};

/// A pose whose legs are about `angle` away from home at most.
PlatformVector pose_at_drive_error(const ParallelRobot& robot, double angle) {
  const auto active = [&robot](double y) {
    return robot.inverse_kinematics(Eigen::Vector3d(0.0, y, 0.0), robot.home_working_mode()).joints.active;
  };
  double y = 0.0;
  while ((active(y) - active(0.0)).lpNorm<Eigen::Infinity>() < angle) y += 1e-4;
  return Eigen::Vector3d(0.0, y, 0.0);
}

/// The current of the second drive rises, but its angle stays what it is.
void freeze(Inputs& in) {
  const Time now = in.posture.joints.acquired;
  in.posture.joints.active[1] = 0.44;
  in.drives.current[1] = 1000.0 * to_seconds(now);
}

const std::map<GateFault, Cause>& causes() {
  using Status = PlatformMotion::Status;
  static const std::map<GateFault, Cause> all{
      {GateFault::loop_late,
       {[](Inputs& in) { in.timing.valid = true, in.timing.lateness = Time(2ms) + Time(1); },
        [](Inputs& in) { in.timing.valid = true, in.timing.lateness = 2ms; }}},
      {GateFault::station_silent, {[](Inputs& in) { in.station.valid = false; }}},
      {GateFault::station_fault, {[](Inputs& in) { in.station.fault = true; }}},
      {GateFault::station_disabled, {[](Inputs& in) { in.station.enabled = false; }}},
      {GateFault::joints_invalid, {[](Inputs& in) { in.posture.joints.valid = false; }}},
      {GateFault::joints_stale, {[](Inputs& in) { in.posture.joints.acquired = in.last_seen; }}},
      {GateFault::encoder_jump,
       {[](Inputs& in) { in.posture.joints.active[2] -= 0.01202; },
        [](Inputs& in) { in.posture.joints.active[2] -= 0.01198; }}},
      {GateFault::encoder_frozen, {freeze}},
      {GateFault::velocity_invalid, {[](Inputs& in) { in.posture.motion.valid = false; }}},
      {GateFault::drives_invalid, {[](Inputs& in) { in.drives.valid = false; }}},
      {GateFault::drives_stale, {[](Inputs& in) { in.drives.acquired = in.last_seen; }}},
      {GateFault::forward_kinematics,
       {[](Inputs& in) { in.posture.platform.status = Status::not_converged; }}},
      {GateFault::encoders_implausible,
       {[](Inputs& in) { in.posture.platform.status = Status::implausible; }}},
      {GateFault::type_1_singularity,
       {[](Inputs& in) { in.posture.measures.det_B = 0.1499; },
        [](Inputs& in) { in.posture.measures.det_B = 0.15; }}},
      {GateFault::type_2_singularity,
       {[](Inputs& in) { in.posture.measures.det_A = -0.1999; },
        [](Inputs& in) { in.posture.measures.det_A = -0.2; }}},
      {GateFault::workspace_radius,
       {[](Inputs& in) { in.posture.platform.pose = Eigen::Vector3d(0.25, 0.246, 0.0); },
        [](Inputs& in) { in.posture.platform.pose = Eigen::Vector3d(0.25, 0.244, 0.0); }}},
      {GateFault::orientation,
       {[](Inputs& in) { in.posture.platform.pose[2] = -29.01 * degree; },
        [](Inputs& in) { in.posture.platform.pose[2] = -28.99 * degree; }}},
      {GateFault::joint_range,
       {[](Inputs& in) { in.reference.valid = false, in.posture.motion.position[1] = -35.01 * degree; },
        [](Inputs& in) { in.reference.valid = false, in.posture.motion.position[1] = 149.99 * degree; }}},
      {GateFault::joint_speed,
       {[](Inputs& in) { in.posture.motion.velocity[2] = -8.01; },
        [](Inputs& in) { in.posture.motion.velocity[2] = -8.0; }}},
      {GateFault::self_collision,
       {[](Inputs& in) { in.posture.measures.sigma_sc = 0.0499; },
        [](Inputs& in) { in.posture.measures.sigma_sc = 0.05; }}},
      {GateFault::contact_unmonitored, {[](Inputs& in) { in.detection.valid = false; }}},
      {GateFault::control_error,
       {[](Inputs& in) { in.reference.pose = pose_at_drive_error(*test::planar_bench(), 25.2 * degree); },
        [](Inputs& in) { in.reference.pose = pose_at_drive_error(*test::planar_bench(), 24.8 * degree); }}},
      {GateFault::command_invalid, {[](Inputs& in) { in.command.valid = false; }}},
      {GateFault::command_stale, {[](Inputs& in) { in.command.computed = in.last_seen; }}},
      {GateFault::command_not_finite, {[](Inputs& in) { in.command.torque[0] = nan; }}},
      {GateFault::torque_jump,
       {[](Inputs& in) { in.command.torque[1] = -40.01; }, [](Inputs& in) { in.command.torque[1] = -40.0; }}},
      {GateFault::operator_stop,
       {[](Inputs& in) { in.buttons.stop = true; },
        [](Inputs& in) { in.buttons = {.start = true, .reset = true, .stop = false}; }}},
  };
  return all;
}

class EveryFault : public testing::TestWithParam<FaultRow> {
 protected:
  const FaultRow& row() const { return GetParam(); }

  /// The pipeline after ten healthy milliseconds.
  void open() {
    for (int k = 0; k < 11; ++k) safety_.tick();
    ASSERT_EQ(safety_.status().phase, GatePhase::open);
  }
  void tick_with(const std::function<void(Inputs&)>& change) {
    Inputs inputs(*safety_.robot, safety_.ticking.now());
    change(inputs);
    safety_.tick(inputs);
  }

  Safety safety_;
};

/// "the laws' torques jump" as TheLawsTorquesJump.
std::string in_one_word(const std::string& sentence) {
  std::string word;
  bool first = true;
  for (const char letter : sentence) {
    const auto code = static_cast<unsigned char>(letter);
    if (std::isalnum(code) != 0) word += static_cast<char>(first ? std::toupper(code) : code);
    first = letter == ' ';
  }
  return word;
}

INSTANTIATE_TEST_SUITE_P(FaultTable, EveryFault,
                         testing::ValuesIn(fault_table().begin(), fault_table().end()),
                         [](const auto& row) { return in_one_word(row.param.description); });

TEST_P(EveryFault, ClosesTheGateInTimeWithItsReaction) {
  ASSERT_TRUE(causes().contains(row().fault)) << "no test brings this fault about: " << row().description;
  open();
  for (int tick = 0; tick < row().latency; ++tick) {
    tick_with(causes().at(row().fault).fault);
    ASSERT_EQ(safety_.status().phase, GatePhase::open) << "earlier than its latency: state the smaller one";
  }
  tick_with(causes().at(row().fault).fault);
  ASSERT_EQ(safety_.status().phase, GatePhase::closed) << row().description;
  EXPECT_EQ(safety_.status().fault, row().fault);
  EXPECT_EQ(safety_.status().reaction, row().reaction);
  const TorqueCommand& torque = safety_.ticking.get(safety_.gate.torque_command);
  if (row().reaction == GateReaction::controlled_stop) {
    EXPECT_TRUE(torque.valid);
    EXPECT_EQ(torque.torque, Eigen::Vector3d(7.0, 8.0, 9.0));
  } else {
    EXPECT_FALSE(torque.valid);
    EXPECT_TRUE(safety_.ticking.get(safety_.gate.brake).engage);
  }
}

TEST_P(EveryFault, LatchesUntilResetAndKeepsTheGateClosedWhileItLasts) {
  ASSERT_TRUE(causes().contains(row().fault));
  open();
  for (int tick = 0; tick <= row().latency; ++tick) tick_with(causes().at(row().fault).fault);
  safety_.tick();
  safety_.tick();
  EXPECT_EQ(safety_.status().phase, GatePhase::closed) << "latched";
  EXPECT_EQ(safety_.status().fault, row().fault);
  safety_.tick(true);
  EXPECT_EQ(safety_.status().phase, GatePhase::open);
}

TEST_P(EveryFault, IsNotSeenAtItsLimit) {
  ASSERT_TRUE(causes().contains(row().fault));
  open();
  tick_with(causes().at(row().fault).just_not);
  EXPECT_EQ(safety_.present(), FaultMask{0});
}

TEST_P(EveryFault, KeepsTheGateFromOpeningAtTheStart) {
  const std::set<GateFault> seen_by_comparison{GateFault::encoder_jump, GateFault::encoder_frozen,
                                               GateFault::torque_jump};
  if (seen_by_comparison.contains(row().fault)) return;  // there is nothing yet to compare with
  ASSERT_TRUE(causes().contains(row().fault));
  for (int tick = 0; tick < 20; ++tick) {
    tick_with([this](Inputs& inputs) {
      inputs.last_seen = -10ms;
      causes().at(row().fault).fault(inputs);
    });
    ASSERT_EQ(safety_.status().phase, GatePhase::waiting);
  }
}

TEST_P(EveryFault, IsDescribedAndPromisesAReaction) {
  EXPECT_NE(std::string(row().description), "");
  EXPECT_NE(row().reaction, GateReaction::none);
  EXPECT_GE(row().latency, 0);
  EXPECT_EQ(first_fault(fault_bit(row().fault)), row().fault);
  EXPECT_EQ(worst_reaction(fault_bit(row().fault)), row().reaction);
}

// ---------------------------------------------------------------- the table as a whole

TEST(FaultTable, NamesEveryFaultOnce) {
  std::set<GateFault> named;
  for (const FaultRow& row : fault_table()) named.insert(row.fault);
  EXPECT_EQ(named.size(), fault_table().size());
  EXPECT_EQ(causes().size(), fault_table().size());
  EXPECT_LT(fault_table().size(), 32U) << "a set of faults has 32 bits, the first for none";
}

TEST(FaultTable, IsEmptyForTheHealthyRobot) {
  Safety safety;
  for (int k = 0; k < 20; ++k) {
    safety.tick();
    EXPECT_EQ(safety.present(), FaultMask{0});
  }
}

TEST(FaultTable, HasNoFirstFaultAndNoReactionForTheEmptySet) {
  EXPECT_EQ(first_fault(0), GateFault::none);
  EXPECT_EQ(worst_reaction(0), GateReaction::none);
}

}  // namespace
}  // namespace flinch
