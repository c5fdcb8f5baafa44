#include "systems/safety/plausibility_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/robot/joint_space_dynamics.h"
#include "tests/support/allocations.h"
#include "tests/systems/safety/watched.h"

namespace flinch {
namespace {

using test::Told;
using test::Watched;

constexpr double degree = std::numbers::pi / 180.0;

/// Ticks with `change` until `fault` is found, 0 for the first; none within 200.
std::optional<int> ticks_until(Watched& watched, GateFault fault, const std::function<void(Told&)>& change) {
  for (int k = 0; k < 200; ++k) {
    if ((watched.tick(change).present & fault_bit(fault)) != 0) return k;
  }
  return std::nullopt;
}

TEST(PlausibilityMonitor, FindsNothingInAnHonestRobotAtRest) {
  Watched watched;
  for (int k = 0; k < 3000; ++k) {
    const Plausibility& found = watched.tick();
    ASSERT_EQ(found.present, FaultMask{0}) << k;
    for (const double ratio : found.ratio) ASSERT_LT(ratio, 0.8) << k;
  }
}

TEST(PlausibilityMonitor, SaysOfWhichDriveTheAngleJumps) {
  for (const double step : {2e-3, -2e-3}) {
    Watched watched;
    const Plausibility& found = watched.tick([step](Told& told) { told.joints.active[1] += step; });
    EXPECT_EQ(found.present, fault_bit(GateFault::encoder_jump));
    EXPECT_EQ(found.drive, 1);
    EXPECT_NEAR(found.of(PlausibilityCheck::jump), 2e-3 / 1e-3 / (5.0 * 172.0 * 1e-3), 0.1);
  }
}

/// A small step shows there and back; a drift shows once.
TEST(PlausibilityMonitor, KnowsAContactFromAStepAndADrift) {
  const auto by = [](double step, double rate) {
    return [=, k = 0](Told& told) mutable { told.joints.active[2] += step + rate * 1e-3 * ++k; };
  };
  Watched stepped;
  EXPECT_EQ(ticks_until(stepped, GateFault::encoder_jump, by(4e-4, 0.0)), 1);
  Watched drifting;
  EXPECT_EQ(ticks_until(drifting, GateFault::encoder_jump, by(0.0, 0.7)), 1);
  Watched pushed;  // 100 rad/s^2, that no drive makes, for 6 ms
  const auto accelerated = [k = 0](Told& told) mutable {
    const double time = 1e-3 * std::min(k++, 6);
    told.joints.active[2] += 0.5 * 100.0 * time * time;
  };
  for (int k = 0; k < 7; ++k) {
    EXPECT_EQ(pushed.tick(accelerated).present & fault_bit(GateFault::encoder_jump), FaultMask{0});
  }
}

TEST(PlausibilityMonitor, MissesTheNoiseOfAnAngleAndOfACurrent) {
  Watched frozen;
  const auto angle =
      ticks_until(frozen, GateFault::encoder_frozen, [](Told& told) { told.joints.active[0] = 1.0; });
  ASSERT_TRUE(angle.has_value());
  EXPECT_LE(*angle, 12);
  Watched stuck;
  const auto current =
      ticks_until(stuck, GateFault::drive_not_following, [](Told& told) { told.drives.current[0] = 0.0; });
  ASSERT_TRUE(current.has_value());
  EXPECT_LE(*current, 12);
}

TEST(PlausibilityMonitor, AsksAfterThreeTicksWhyACurrentWasNotCommanded) {
  for (const double wrong : {0.3, -0.3}) {
    Watched watched;
    const auto off = [wrong](Told& told) { told.drives.current[1] += wrong; };
    EXPECT_EQ(ticks_until(watched, GateFault::drive_not_following, off), 2);
  }
  Watched near;
  EXPECT_EQ(
      ticks_until(near, GateFault::drive_not_following, [](Told& told) { told.drives.current[1] += 0.1; }),
      std::nullopt);
}

TEST(PlausibilityMonitor, BelievesACurrentThatFollowsWithinSixTicks) {
  Watched watched;
  std::array<double, 6> delayed{};
  for (int k = 0; k < 200; ++k) {
    const double torque = 60.0 * std::sin(0.05 * k);
    const Plausibility& found = watched.tick([&](Told& told) {
      told.command.torque[1] = torque;
      told.drives.current[1] += delayed[static_cast<std::size_t>(k + 1) % 6] / 6.0;
    });
    delayed[static_cast<std::size_t>(k) % 6] = torque;
    EXPECT_LT(found.of(PlausibilityCheck::tube), 1.0) << k;
  }
}

TEST(PlausibilityMonitor, ComparesEncodersWithTheUnitOnThePlatform) {
  Watched turned;
  const auto rate = ticks_until(turned, GateFault::motion_contradicted,
                                [](Told& told) { told.imu.angular_velocity[2] += 0.2; });
  ASSERT_TRUE(rate.has_value());
  EXPECT_LE(*rate, 6);
  Watched pulled;
  const auto force = ticks_until(pulled, GateFault::motion_contradicted,
                                 [](Told& told) { told.imu.specific_force[0] += 20.0; });
  ASSERT_TRUE(force.has_value());
  EXPECT_LE(*force, 22);
}

TEST(PlausibilityMonitor, ComparesActiveWithPassiveEncoders) {
  const auto wrong = [](double angle) { return [angle](Told& told) { told.joints.passive[2] += angle; }; };
  Watched far;
  EXPECT_EQ(ticks_until(far, GateFault::encoders_implausible, wrong(0.51 * degree)), 0);
  Watched near;
  const auto mean = ticks_until(near, GateFault::encoders_implausible, wrong(-0.36 * degree));
  ASSERT_TRUE(mean.has_value());
  EXPECT_LE(*mean, 16);
  Watched within;
  EXPECT_EQ(ticks_until(within, GateFault::encoders_implausible, wrong(0.34 * degree)), std::nullopt);
  Watched turned;
  EXPECT_EQ(ticks_until(turned, GateFault::encoders_implausible, wrong(2.0 * std::numbers::pi)),
            std::nullopt);
}

TEST(PlausibilityMonitor, SaysWhatHasBeenThereAndIsNoMore) {
  Watched watched;
  const auto blind = [](Told& told) { told.joints.passive_valid = told.imu.valid = false; };
  for (int k = 0; k < 19; ++k) EXPECT_FALSE(watched.tick(blind).passive_lost);
  EXPECT_TRUE(watched.tick(blind).passive_lost);
  EXPECT_TRUE(watched.tick(blind).imu_lost);
  EXPECT_FALSE(watched.tick().passive_lost);
}

TEST(PlausibilityMonitor, WondersWhyNothingMovesThoughTorquesChange) {
  const auto wind_up = [](double rate) {
    return [=, k = 0](Told& told) mutable {
      told.command.torque.setConstant(rate * ++k);
      told.drives.current = told.command.torque / 6.0;
    };
  };
  Watched stuck;
  const auto found = ticks_until(stuck, GateFault::drives_without_effect, wind_up(0.8));
  ASSERT_TRUE(found.has_value());
  EXPECT_LE(*found, 33);
  Watched slow;
  EXPECT_EQ(ticks_until(slow, GateFault::drives_without_effect, wind_up(0.5)), std::nullopt);
}

/// All drives slow down to rest with 25 rad/s^2, which then dies away with `jerk` [rad/s^3]: torques fall by
/// 12 Nm and more, and next to nothing moves from then on. `stuck`: the same torques, and it never moved.
std::optional<int> coming_to_rest(double jerk, bool stuck) {
  constexpr double hardest = 25.0;  // [rad/s^2]
  const test::Posture home(*test::planar_rig(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0ns);
  const Eigen::Matrix3d inertia = joint_space_dynamics(home.kinematics, home.dynamics).M_qa;
  Watched watched;
  const auto slow_down = [=, k = 0](Told& told) mutable {
    const double left = std::max(0.0, 0.06 - 1e-3 * k++);  // until it rests [s]
    const double dying = hardest / jerk;
    const double before = std::max(0.0, left - dying);  // with the whole acceleration
    const double rate = 0.5 * jerk * dying * dying, way = rate * dying / 3.0;
    const double distance = left < dying ? jerk * left * left * left / 6.0
                                         : way + rate * before + 0.5 * hardest * before * before;
    if (!stuck) told.joints.active.array() -= distance;
    told.command.torque = -inertia * Eigen::Vector3d::Constant(std::min(hardest, jerk * left));
    told.drives.current = told.command.torque / 6.0;
  };
  return ticks_until(watched, GateFault::drives_without_effect, slow_down);
}

TEST(PlausibilityMonitor, KnowsARobotThatComesToRestFromOneThatNothingMoves) {
  for (const double jerk : {600.0, 1200.0, 2500.0, 5000.0, 25000.0}) {
    EXPECT_EQ(coming_to_rest(jerk, false), std::nullopt) << jerk;
    EXPECT_TRUE(coming_to_rest(jerk, true).has_value()) << jerk;
  }
}

TEST(PlausibilityMonitor, NoticesADriveThatItsBrakeDoesNotHold) {
  Watched watched;
  const auto sinking = [k = 0](Told& told) mutable {
    Watched::held(told);
    told.gate = {.phase = GatePhase::closed, .fault = GateFault::station_fault};
    told.joints.active[1] += 0.2e-3 * ++k;
  };
  const auto found = ticks_until(watched, GateFault::brake_not_holding, sinking);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(*found, 60);
  EXPECT_LT(*found, 66);
}

TEST(PlausibilityMonitor, DoesNotBelieveAboutABrakeWhatItsFaultHasCalledFalse) {
  Watched watched;
  const auto drifting = [k = 0](Told& told) mutable {
    Watched::held(told);
    told.gate = {.phase = GatePhase::closed,
                 .fault = GateFault::encoder_jump,
                 .faults = fault_bit(GateFault::encoder_jump)};
    told.joints.active[1] += 5e-3 * ++k;
  };
  EXPECT_EQ(ticks_until(watched, GateFault::brake_not_holding, drifting), std::nullopt);
}

TEST(PlausibilityMonitor, NoticesAStopThatTakesNoEnergyOut) {
  for (const double gain : {1.0, -1.0}) {  // a rate that stays; one that falls
    Watched watched;
    const Time begin = Time(1ms) * watched.ticks();
    const auto stopping = [=, k = 0](Told& told) mutable {
      told.gate = {.phase = GatePhase::closed, .reaction = GateReaction::controlled_stop, .since = begin};
      const double time = 1e-3 * ++k;
      const double angle = gain > 0 ? time : 0.03 * (1.0 - std::exp(-time / 0.03));
      told.joints.active.array() += angle;
    };
    const auto found = ticks_until(watched, GateFault::stop_ineffective, stopping);
    EXPECT_EQ(found.has_value(), gain > 0);
    if (found) {
      EXPECT_LT(*found, 25);
    }
  }
}

/// A robot that has come to rest in a controlled stop, and is driven again with 10 rad/s^2; slowly: with 0.1
/// rad/s^2, as a hand does it.
std::optional<int> driven_after_rest(double acceleration) {
  Watched watched;
  const Time begin = Time(1ms) * watched.ticks();
  const auto driven = [=, k = 0](Told& told) mutable {
    told.gate = {.phase = GatePhase::closed, .reaction = GateReaction::controlled_stop, .since = begin};
    const double time = 1e-3 * std::max(0, ++k - 100);
    told.joints.active.array() += 0.5 * acceleration * time * time;
  };
  return ticks_until(watched, GateFault::stop_ineffective, driven);
}

TEST(PlausibilityMonitor, WatchesAStoppedRobotThatHasComeToRest) {
  const std::optional<int> found = driven_after_rest(10.0);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(*found, 100);
  EXPECT_LE(*found, 145) << "the speed of a hand is reached after some 35 ms";
  EXPECT_EQ(driven_after_rest(0.1), std::nullopt) << "a hand may lead a stopped robot slowly";
}

TEST(PlausibilityMonitor, BrakesAStopOfWhichItSeesNothing) {
  for (const int blind : {9, 12}) {
    Watched watched;
    const Time begin = Time(1ms) * watched.ticks();
    const auto unseen = [=, k = 0](Told& told) mutable {
      told.gate = {.phase = GatePhase::closed, .reaction = GateReaction::controlled_stop, .since = begin};
      told.joints.valid = ++k > blind;
    };
    EXPECT_EQ(ticks_until(watched, GateFault::stop_ineffective, unseen).has_value(), blind > 10) << blind;
  }
}

/// What follows where the station says from now on that the brakes are closed, and the drives move at `rate`.
std::optional<int> said_to_be_braked(double rate, int said = 1000) {
  Watched watched;
  const auto braked = [=, k = 0](Told& told) mutable {
    told.station.braked = k++ < said;
    told.joints.active.array() += rate * 1e-3 * k;
  };
  return ticks_until(watched, GateFault::status_contradicted, braked);
}

TEST(PlausibilityMonitor, DoesNotBelieveThatAMovingRobotIsBraked) {
  EXPECT_LE(said_to_be_braked(1.0).value_or(1000), 6);
  EXPECT_LE(said_to_be_braked(0.0).value_or(1000), 22) << "nor that brakes close on their own for long";
  EXPECT_EQ(said_to_be_braked(1.0, 3), std::nullopt) << "a command that was lost closes brakes for a moment";
  EXPECT_EQ(said_to_be_braked(0.0, 15), std::nullopt);
}

TEST(PlausibilityMonitor, WaitsForBrakesThatOpenSlowly) {
  for (const int opening : {400, 600}) {
    Watched watched;
    for (int k = 0; k < 10; ++k) watched.tick(Watched::held);
    bool found = false;
    for (int k = 0; k < opening; ++k) {
      const Plausibility& seen = watched.tick([](Told& told) { told.station.braked = true; });
      found = found || (seen.present & fault_bit(GateFault::status_contradicted)) != 0;
    }
    EXPECT_EQ(found, opening > 500);
  }
}

TEST(PlausibilityMonitor, DoesNotDoubtAStationWhoseBrakesWereToldToClose) {
  Watched watched;
  const auto closing = [k = 0](Told& told) mutable {
    Watched::held(told);
    told.gate = {.phase = GatePhase::closed};
    told.joints.active.array() += 1e-3 * std::min(++k, 30);
  };
  EXPECT_EQ(ticks_until(watched, GateFault::status_contradicted, closing), std::nullopt);
}

/// Ticks for which a robot that is held goes on learning, once it is told anything; `change`: of each tick.
int ticks_of_learning(const std::function<void(Told&)>& change) {
  bool told_anything = false;
  Watched watched(
      [&](Told& told) {
        Watched::held(told);
        if (!told_anything) told.joints.valid = told.drives.valid = told.imu.valid = false;
      },
      test::watched_limits(), 0);
  told_anything = true;
  int ticks = 0;
  while (watched.tick(change).learning) ++ticks;
  return ticks;
}

TEST(PlausibilityMonitor, SaysThatItLearnsUntilAllNoiseIsKnown) {
  const int ticks = ticks_of_learning([](Told&) {});
  EXPECT_GE(ticks, 50);
  EXPECT_LE(ticks, 55);
}

TEST(PlausibilityMonitor, LearnsNoLongerThanASecondHoweverFewSamplesCome) {
  const auto slow = [](Told& told) { told.imu.acquired = told.imu.acquired / 25ms * 25ms; };
  EXPECT_GT(ticks_of_learning(slow), 500);
  EXPECT_LE(ticks_of_learning(slow), 1000);
}

TEST(PlausibilityMonitor, LearnsNothingOnceTheRobotHasMoved) {
  Watched watched([](Told&) {}, test::watched_limits(), 0);
  EXPECT_FALSE(watched.tick().learning);
  EXPECT_FALSE(watched.tick(Watched::held).learning);
}

TEST(PlausibilityMonitor, NeverAllocates) {
  Watched watched;
  std::int64_t allocations = 0;
  for (int k = 0; k < 50; ++k) {
    const std::function<void(Told&)> lie = [](Told& told) { told.joints.active[1] = 1.0; };
    const test::AllocationCounter counter;
    watched.tick(lie);
    allocations += counter.count();
  }
  EXPECT_EQ(allocations, 0);
}

TEST(PlausibilityMonitor, RefusesLimitsThatCouldNotBeKept) {
  PlausibilityLimits bad = test::watched_limits();
  bad.parity = 0.0;
  bad.torque_constant = Eigen::Vector2d::Ones();
  try {
    const PlausibilityMonitor monitor(test::planar_rig(), bad);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

}  // namespace
}  // namespace flinch
