// What broken encoders do to the whole rig, in closed loop.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/fault/guarded_rig.h"

namespace flinch {
namespace {

using test::EncoderDamage;
using test::GuardedBenchSettings;
using test::GuardedRig;
using test::middle_of_passage;
using test::passing_at;

constexpr FaultMask encoder_faults =
    fault_bit(GateFault::encoder_frozen) | fault_bit(GateFault::encoder_jump);

EncoderDamage frozen(std::size_t drive) {
  EncoderDamage damage;
  damage.active_frozen[drive] = true;
  return damage;
}

EncoderDamage all_frozen() {
  return {.active_frozen = {true, true, true}, .passive_frozen = true, .active_offset = {0.0, 0.0, 0.0}};
}

/// With no other witness than chains that do not close.
GuardedBenchSettings without_encoder_faults(GuardedBenchSettings settings) {
  settings.control.faults.max_unseen_motion = settings.control.faults.max_unseen_current = 1e9;
  PlausibilityLimits& limits = settings.control.plausibility;
  limits.jump = limits.isolated = limits.pair = limits.parity = 1e9;
  limits.quiet_ticks = 1'000'000;
  return settings;
}

/// How long after the damage, in the middle of a passage, the fault shows.
std::optional<Time> time_to_find(FaultMask faults, const GuardedBenchSettings& settings, double speed,
                                 const EncoderDamage& damage) {
  GuardedRig rig(settings);
  rig.run_until(middle_of_passage(speed));
  EXPECT_EQ(rig.gate().phase, GatePhase::open);
  rig.damage(damage);
  return rig.time_until(faults, 100ms);
}

// ---------------------------------------------------------------- frozen

struct Freeze {
  double speed;  ///< [m/s]
  Time bound;    ///< until the fault is found
};

class FrozenEncoder : public testing::TestWithParam<Freeze> {
 protected:
  double speed() const { return GetParam().speed; }
  void record(const std::string& what, const std::optional<Time>& time) {
    RecordProperty(what + "_ms", time ? std::to_string(*time / 1ms) : "more than 100");
  }
};

INSTANTIATE_TEST_SUITE_P(Speeds, FrozenEncoder,
                         testing::Values(Freeze{0.1, 40ms}, Freeze{0.3, 6ms}, Freeze{0.9, 6ms}),
                         [](const auto& freeze) {
                           return "At" + std::to_string(std::lround(1e3 * freeze.param.speed)) + "MmPerS";
                         });

TEST_P(FrozenEncoder, IsFoundInTimeAndBeforeTheChainsContradictIt) {
  for (std::size_t drive = 0; drive < 3; ++drive) {
    const auto found = time_to_find(encoder_faults, passing_at(speed()), speed(), frozen(drive));
    const auto contradicted =
        time_to_find(fault_bit(GateFault::encoders_implausible), without_encoder_faults(passing_at(speed())),
                     speed(), frozen(drive));
    record("drive_" + std::to_string(drive + 1), found);
    record("drive_" + std::to_string(drive + 1) + "_otherwise", contradicted);
    ASSERT_TRUE(found.has_value());
    EXPECT_LE(*found, GetParam().bound);
    EXPECT_LT(*found, contradicted.value_or(100ms));
  }
}

/// Nothing else contradicts these readings.
TEST_P(FrozenEncoder, IsFoundWhenAllAreFrozenTogether) {
  const auto found = time_to_find(encoder_faults, passing_at(speed()), speed(), all_frozen());
  record("all", found);
  ASSERT_TRUE(found.has_value());
  EXPECT_LE(*found, GetParam().bound);
}

TEST_P(FrozenEncoder, EndsInClosedBrakesAndRest) {
  for (const EncoderDamage& damage : {frozen(0), frozen(1), frozen(2), all_frozen()}) {
    GuardedRig rig(passing_at(speed()));
    rig.run_until(middle_of_passage(speed()));
    const Eigen::Vector3d where = rig.pose();
    rig.damage(damage);
    rig.run_until(rig.now() + 400ms);
    EXPECT_NE(fault_bit(rig.gate().fault) & encoder_faults, FaultMask{0});
    EXPECT_EQ(rig.gate().reaction, GateReaction::zero_torque_and_brake);
    EXPECT_LT(rig.velocity().norm(), 1e-3);
    EXPECT_LT((rig.pose() - where).head<2>().norm(), 0.03);
  }
}

// ---------------------------------------------------------------- jumping

TEST(JumpingEncoder, ClosesTheBrakesBeforeItsVelocityBecomesTorque) {
  for (const double jump : {0.05, -2.0}) {
    GuardedRig rig(passing_at(0.3));
    rig.run_until(middle_of_passage(0.3));
    rig.damage({.active_frozen = {}, .passive_frozen = false, .active_offset = {0.0, jump, 0.0}});
    rig.tick();
    EXPECT_EQ(rig.gate().fault, GateFault::encoder_jump);
    EXPECT_FALSE(rig.torque().valid);
    rig.run_until(rig.now() + 400ms);
    EXPECT_LT(rig.velocity().norm(), 1e-3);
  }
}

// ---------------------------------------------------------------- no false alarm

void expect_healthy_encoders(const GuardedBenchSettings& settings, Time duration) {
  for (const bool ideal : {false, true}) {
    GuardedBenchSettings each = settings;
    if (ideal) each.station = with_ideal_sensors(settings.station);
    GuardedRig rig(each);
    while (rig.now() < duration) {
      rig.tick();
      ASSERT_EQ(rig.faults() & encoder_faults, FaultMask{0}) << rig.now() / 1ms << " ms, ideal: " << ideal;
    }
    EXPECT_NE(rig.gate().phase, GatePhase::waiting);
  }
}

TEST(HealthyEncoders, AreTrustedAtRest) {
  GuardedBenchSettings settings = passing_at(0.3);
  settings.control.trajectory.path.reset();
  expect_healthy_encoders(settings, 2s);
}

TEST(HealthyEncoders, AreTrustedInMotion) {
  for (const double speed : {0.02, 0.9}) expect_healthy_encoders(passing_at(speed), 2s);
}

/// Runs into a post; `reacts`: retracts from it, otherwise presses on.
void collide(double speed, bool reacts) {
  GuardedBenchSettings settings = passing_at(speed);
  ObstacleForm post;
  post.position_in_base = {0.2, 0.0, 0.0};
  settings.station.rig.obstacles = {std::make_shared<const FixedObstacle>(post)};
  if (!reacts) {
    settings.control.contact_detector.reaction = {1e6, 1e6};
    settings.control.contact_detector.hard = {1e6, 1e6};
  }
  expect_healthy_encoders(settings, 2s);
}

TEST(HealthyEncoders, AreTrustedInACollisionAndAfterIt) { collide(0.7, true); }

TEST(HealthyEncoders, AreTrustedWhilePressedAgainstAnObstacle) { collide(0.3, false); }

TEST(HealthyEncoders, AreTrustedInZeroGravityAndWhenPushed) {
  GuardedBenchSettings settings = passing_at(0.3);
  settings.control.trajectory.path.reset();
  settings.station.applied_wrench = {{.peak_in_base = PlatformVector{{90.0, 0.0, 0.0}},
                                      .start = 400ms,
                                      .rise = 20ms,
                                      .hold = 50ms,
                                      .fall = 20ms}};
  expect_healthy_encoders(settings, 2s);
}

}  // namespace
}  // namespace flinch
