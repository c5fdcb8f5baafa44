#include "systems/safety/fault_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/systems/safety/gated_inputs.h"

namespace flinch {
namespace {

using test::Inputs;
using test::Safety;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(FaultMonitor, ToleratesTwoMissingSamples) {
  Safety safety;
  safety.tick();
  for (int missing = 0; missing < 2; ++missing) {
    Inputs inputs(*safety.robot, safety.ticking.now());
    inputs.station.valid = inputs.posture.joints.valid = inputs.drives.valid = false;
    safety.tick(inputs);
    EXPECT_EQ(safety.status().phase, GatePhase::open);
  }
  safety.tick();
  EXPECT_EQ(safety.status().phase, GatePhase::open);
}

TEST(FaultMonitor, TakesAReadingThatIsNotFiniteForMissing) {
  Safety safety;
  safety.tick();
  for (int missing = 0; missing < 3; ++missing) {
    Inputs inputs(*safety.robot, safety.ticking.now());
    inputs.posture.joints.active[0] = nan;
    safety.tick(inputs);
  }
  EXPECT_EQ(safety.status().fault, GateFault::joints_invalid);
}

TEST(FaultMonitor, FindsAReferenceThatCannotBeReached) {
  Safety safety;
  safety.tick();
  for (const PlatformVector& pose : {PlatformVector(Eigen::Vector3d(5.0, 0.0, 0.0)),
                                     PlatformVector(Eigen::Vector3d(nan, 0, 0)), PlatformVector()}) {
    Inputs inputs(*safety.robot, safety.ticking.now());
    inputs.reference.pose = pose;
    safety.tick(inputs);
    EXPECT_EQ(safety.present(), fault_bit(GateFault::control_error));
  }
}

TEST(FaultMonitor, AsksForNoControlErrorWhereNoReferenceIsFollowed) {
  Safety safety;
  Inputs inputs(*safety.robot, safety.ticking.now());
  inputs.reference = {};
  safety.tick(inputs);
  EXPECT_EQ(safety.present(), FaultMask{0});
}

TEST(FaultMonitor, JudgesJumpsWithinTheTorqueRange) {
  Safety safety;
  const auto ask = [&safety](double torque) {
    Inputs inputs(*safety.robot, safety.ticking.now());
    inputs.command.torque[0] = torque;
    safety.tick(inputs);
    return safety.present();
  };
  EXPECT_EQ(ask(70.0), FaultMask{0});
  EXPECT_EQ(ask(500.0), FaultMask{0}) << "counts as 100 Nm";
  EXPECT_EQ(ask(-500.0), fault_bit(GateFault::torque_jump));
}

TEST(FaultMonitor, FindsLegsThatComeTooNearThePlatform) {
  FaultLimits limits;
  limits.workspace.min_platform_gap = 0.005;
  for (const double gap : {0.0, 0.0049, 0.0051, std::numeric_limits<double>::infinity()}) {
    test::Safety safety{test::planar_rig(), limits};
    test::Inputs inputs(*safety.robot, safety.ticking.now());
    inputs.posture.measures.platform_gap = gap;
    safety.tick(inputs);
    EXPECT_EQ((safety.present() & fault_bit(GateFault::self_collision)) != 0, gap < 0.005) << gap;
  }
}

TEST(FaultMonitor, SaysThatTheRobotRestsOnlyWhereTheRatesSaySo) {
  const double rest_speed = FaultLimits().rest_speed;
  Safety safety;
  const auto rests = [&safety](double rate, bool valid) {
    Inputs inputs(*safety.robot, safety.ticking.now());
    inputs.posture.motion.velocity[1] = rate;
    inputs.posture.motion.valid = valid;
    safety.tick(inputs);
    return safety.ticking.get(safety.monitor.faults).at_rest;
  };
  EXPECT_TRUE(rests(0.0, true));
  EXPECT_TRUE(rests(-0.9 * rest_speed, true));
  EXPECT_FALSE(rests(1.1 * rest_speed, true));
  EXPECT_FALSE(rests(-1.1 * rest_speed, true));
  EXPECT_FALSE(rests(nan, true));
  EXPECT_FALSE(rests(0.0, false)) << "what is not known is no rest";
}

/// No input that is not a number may pass unnoticed where it matters, and none may reach the station.
TEST(FaultMonitor, FindsEveryNumberThatIsNone) {
  const std::vector<std::function<double&(Inputs&)>> numbers{
      [](Inputs& in) -> double& { return in.posture.motion.position[1]; },
      [](Inputs& in) -> double& { return in.posture.motion.velocity[1]; },
      [](Inputs& in) -> double& { return in.posture.platform.pose[1]; },
      [](Inputs& in) -> double& { return in.posture.platform.velocity[1]; },
      [](Inputs& in) -> double& { return in.posture.measures.det_A; },
      [](Inputs& in) -> double& { return in.posture.measures.det_B; },
      [](Inputs& in) -> double& { return in.posture.measures.sigma_sc; },
      [](Inputs& in) -> double& { return in.reference.pose[1]; },
      [](Inputs& in) -> double& { return in.command.torque[1]; }};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
      if (i >= 4 && i <= 6 && !std::isnan(bad)) continue;  // infinitely far from a singularity is fine
      Safety safety;
      safety.tick();
      Inputs inputs(*safety.robot, safety.ticking.now());
      numbers[i](inputs) = bad;
      safety.tick(inputs);
      EXPECT_NE(safety.present(), FaultMask{0}) << i;
      EXPECT_TRUE(safety.ticking.get(safety.gate.torque_command).torque.allFinite()) << i;
    }
  }
}

TEST(FaultMonitor, NeverAllocates) {
  Safety safety;
  safety.tick();
  const test::AllocationCounter counter;
  safety.tick();
  EXPECT_EQ(counter.count(), 0);
}

TEST(FaultLimits, MustNotExcludeTheRobotAtHome) {
  FaultLimits limits;
  limits.workspace.min_abs_det_A = 0.6;
  EXPECT_THROW(FaultMonitor(test::planar_rig(), limits), SetupError);
}

TEST(FaultLimits, NameEverythingThatIsWrongWithThem) {
  FaultLimits limits;
  limits.max_joint_speed = 0.0;
  limits.rest_speed = nan;
  limits.max_control_error = nan;
  limits.max_torque_jump = -1.0;
  limits.longest_gap = -1ms;
  EXPECT_EQ(problems(limits, *test::planar_rig()).size(), 5U);
  EXPECT_TRUE(problems(FaultLimits(), *test::planar_rig()).empty());
}

}  // namespace
}  // namespace flinch
