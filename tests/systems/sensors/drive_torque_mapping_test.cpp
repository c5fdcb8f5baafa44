#include "systems/sensors/drive_torque_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/sensors/velocity_filter.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double T = 1e-3;

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
}

/// Aligned with a velocity of this form, or not.
DriveTorqueMapping& add_mapping(DiagramBuilder& builder, std::optional<LowPassForm> form,
                                const JointVector& torque_constant = JointVector::Ones(3),
                                const Cogging& cogging = {}, const JointVector& delay = {},
                                Time period = 1ms) {
  const auto aligned_with = form ? std::optional(LowPassSettings{30.0, *form}) : std::nullopt;
  return builder.add<DriveTorqueMapping>(
      "mapping", rig(), DriveTorqueSettings{torque_constant, Sampling::each(period), cogging, delay},
      aligned_with);
}

struct Mapping {
  explicit Mapping(std::optional<LowPassForm> form, const JointVector& torque_constant = JointVector::Ones(3),
                   const Cogging& cogging = {}, const JointVector& delay = {}, Time period = 1ms)
      : builder("mapping", period),
        block(add_mapping(builder, form, torque_constant, cogging, delay, period)),
        joints(builder.export_input("joints", block.joints)),
        drives(builder.export_input("drives", block.drives)),
        status(builder.export_input("status", block.status)),
        ticking(builder) {}

  const DriveTorque& see(const DriveReading& reading) {
    ticking.set(drives, reading);
    ticking.tick();
    return ticking.get(block.torque);
  }
  const DriveTorque& see(const JointVector& current) { return see({ticking.now(), true, current}); }
  const DriveTorque& see_at(const JointVector& position, const JointVector& current) {
    ticking.set(joints, {ticking.now(), true, false, position, {}});
    return see(current);
  }
  const DriveTorque& miss() { return see({ticking.now(), false, JointVector::Constant(3, nan)}); }

  DiagramBuilder builder;
  DriveTorqueMapping& block;
  InputPort<JointReading> joints;
  InputPort<DriveReading> drives;
  InputPort<StationStatus> status;
  test::Ticking ticking;
};

TEST(DriveTorqueMapping, BeginsItsLowPassAnewWhenTheBrakesOpen) {
  Mapping mapping(LowPassForm::tustin);
  StationStatus station{.acquired = 0ms, .valid = true, .enabled = true, .braked = true};
  mapping.ticking.set(mapping.status, station);
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(mapping.see(JointVector::Zero(3)).braked);
  station.braked = false;
  mapping.ticking.set(mapping.status, station);
  const JointVector held{{5.0, -3.0, 8.0}};
  EXPECT_EQ(mapping.see(held).torque, held);
  EXPECT_FALSE(mapping.see(held).braked);
  EXPECT_EQ(mapping.see(held).torque, held);
}

TEST(DriveTorqueMapping, MultipliesEachCurrentByTheConstantOfItsDrive) {
  Mapping mapping(std::nullopt, JointVector{{6.021, 6.6116, 6.7315}});
  mapping.miss();
  const DriveTorque& torque = mapping.see(JointVector{{1.0, -2.0, 0.5}});
  EXPECT_TRUE(torque.valid);
  EXPECT_EQ(torque.acquired, 1ms);
  EXPECT_LT((torque.torque - JointVector{{6.021, -13.2232, 3.36575}}).norm(), 1e-14);
}

// Currents that change evenly: the torque is that of a time `delay` ago.
TEST(DriveTorqueMapping, IsBehindTheCurrentWhereThatIsKnown) {
  const JointVector constant{{6.0, 5.0, 4.0}}, delay{{0.25e-3, -0.5e-3, 0.0}}, slope{{100.0, -40.0, 7.0}};
  Mapping mapping(std::nullopt, constant, {}, delay);
  const auto current = [&](double time) -> JointVector { return JointVector::Ones(3) + slope * time; };
  EXPECT_EQ(mapping.see(current(0.0)).torque, constant) << "nothing is known of before";
  for (int k = 1; k < 20; ++k) {
    const DriveTorque& torque = mapping.see(current(T * k));
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(torque.torque[i], constant[i] * current(T * k - delay[i])[i], 1e-12) << k << ", " << i;
  }
}

TEST(DriveTorqueMapping, IsBehindTheCurrentByMoreThanATickWhereTicksAreShort) {
  const JointVector delay{{0.6e-3, 1e-3, 0.1e-3}}, slope{{100.0, -40.0, 7.0}};
  Mapping mapping(std::nullopt, JointVector::Ones(3), {}, delay, 250us);
  const auto current = [&](double time) -> JointVector { return JointVector::Ones(3) + slope * time; };
  for (int k = 0; k < 20; ++k) {
    const double now = 0.25e-3 * k;
    const DriveTorque& torque = mapping.see(current(now));
    if (k < 5) continue;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(torque.torque[i], current(now - delay[i])[i], 1e-12) << k;
  }
}

TEST(DriveTorqueMapping, TakesTheCurrentAsItIsBehindAGap) {
  Mapping mapping(std::nullopt, JointVector::Ones(3), {}, JointVector::Constant(3, 0.5e-3));
  mapping.see(JointVector::Zero(3));
  mapping.miss();
  EXPECT_NEAR(mapping.see(JointVector::Ones(3)).torque[0], 0.75, 1e-15) << "2 ms for the step";
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(mapping.miss().valid);
  EXPECT_EQ(mapping.see(JointVector::Constant(3, 3.0)).torque[0], 3.0);
}

// What the brakes held, the drives hold at once when they open.
TEST(DriveTorqueMapping, ForgetsTheCurrentsOfClosedBrakes) {
  for (const auto form : {std::optional<LowPassForm>(), std::optional(LowPassForm::tustin)}) {
    Mapping mapping(form, JointVector::Ones(3), {}, JointVector::Constant(3, 0.5e-3));
    StationStatus station{.acquired = 0ms, .valid = true, .enabled = true, .braked = true};
    mapping.ticking.set(mapping.status, station);
    for (int k = 0; k < 5; ++k) mapping.see(JointVector::Zero(3));
    station.braked = false;
    mapping.ticking.set(mapping.status, station);
    const JointVector held{{5.0, -3.0, 8.0}};
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(mapping.see(held).torque.isApprox(held)) << k;
  }
}

TEST(DriveTorqueMapping, DoesNotAllocateWithADelay) {
  Mapping mapping(LowPassForm::tustin, JointVector::Ones(3), {}, JointVector::Constant(3, 0.5e-3));
  mapping.see(JointVector::Zero(3));
  const test::AllocationCounter counter;
  for (int k = 1; k < 20; ++k) mapping.see(JointVector::Constant(3, k));
  EXPECT_EQ(counter.count(), 0);
}

TEST(DriveTorqueMapping, SaysTheSameOfAReadingThatComesAgain) {
  Mapping mapping(std::nullopt, JointVector::Ones(3), {}, JointVector::Constant(3, 0.5e-3));
  mapping.see(JointVector::Zero(3));
  const DriveReading reading{mapping.ticking.now(), true, JointVector::Ones(3)};
  EXPECT_EQ(mapping.see(reading).torque[0], 0.5);
  EXPECT_EQ(mapping.see(reading).torque[0], 0.5);
}

TEST(DriveTorqueMapping, RefusesADelayOfSomeDrivesOnly) {
  EXPECT_THROW(Mapping(std::nullopt, JointVector::Ones(3), {}, JointVector::Zero(2)), SetupError);
  EXPECT_THROW(Mapping(std::nullopt, JointVector::Ones(3), {}, JointVector::Constant(3, nan)), SetupError);
  EXPECT_THROW(Mapping(std::nullopt, JointVector::Ones(3), {}, JointVector::Constant(3, 1.1e-3)), SetupError)
      << "more than a period";
}

TEST(DriveTorqueMapping, IsNotValidWhereTheReadingIsNot) {
  for (const auto form : {std::optional<LowPassForm>(), std::optional(LowPassForm::tustin)}) {
    Mapping mapping(form);
    mapping.see(JointVector::Ones(3));
    const DriveReading unusable[] = {{1ms, false, JointVector::Ones(3)},
                                     {1ms, true, JointVector::Constant(3, nan)},
                                     {1ms, true, JointVector::Ones(2)},
                                     {1ms, true, JointVector()}};
    for (const DriveReading& reading : unusable) {
      const DriveTorque& torque = mapping.see(reading);
      EXPECT_FALSE(torque.valid);
      EXPECT_EQ(torque.torque, JointVector::Zero(3));
    }
  }
}

class AlignedTorque : public testing::TestWithParam<LowPassForm> {};
INSTANTIATE_TEST_SUITE_P(DriveTorqueMapping, AlignedTorque,
                         testing::Values(LowPassForm::tustin, LowPassForm::backward_difference));

// Drives whose rates over the intervals happen to be the torques: what comes out must be the same numbers.
TEST_P(AlignedTorque, LagsAsTheVelocityDoes) {
  DiagramBuilder builder("both");
  auto& velocity =
      builder.add<VelocityFilter>("velocity", rig(), VelocityFilterSettings{{30.0, GetParam()}, {}});
  auto& mapping = add_mapping(builder, GetParam());
  builder.connect(builder.optional_input<JointReading>("encoders"), mapping.joints);
  builder.connect(builder.optional_input<StationStatus>("brakes"), mapping.status);
  const auto joints = builder.export_input("joints", velocity.joints);
  const auto drives = builder.export_input("drives", mapping.drives);
  test::Ticking ticking(builder);

  RandomGenerator random(1);
  JointVector position = JointVector::Zero(3);
  for (int k = 0; k < 500; ++k) {
    const JointVector rate = JointVector::NullaryExpr(3, [&] { return random.uniform(-3.0, 3.0); });
    const Time now = ticking.now();
    if (k > 0) position += T * rate;
    ticking.set(joints, {now, true, false, position, {}});
    ticking.set(drives, {now, k > 0, rate});
    ticking.tick();
    if (k > 0) {
      ASSERT_LT((ticking.get(velocity.motion).velocity - ticking.get(mapping.torque).torque).norm(), 1e-11);
    }
  }
}

// A unit mass, pushed by torques that are held from tick to tick.
TEST_P(AlignedTorque, ExplainsTheChangeOfTheFilteredMomentumAsTheMeanOfItsTwoEnds) {
  DiagramBuilder builder("mass");
  auto& velocity =
      builder.add<VelocityFilter>("velocity", rig(), VelocityFilterSettings{{30.0, GetParam()}, {}});
  auto& mapping = add_mapping(builder, GetParam());
  builder.connect(builder.optional_input<JointReading>("encoders"), mapping.joints);
  builder.connect(builder.optional_input<StationStatus>("brakes"), mapping.status);
  const auto joints = builder.export_input("joints", velocity.joints);
  const auto drives = builder.export_input("drives", mapping.drives);
  test::Ticking ticking(builder);

  RandomGenerator random(2);
  JointVector torque = JointVector::Zero(3);
  JointVector q = JointVector::Zero(3);
  JointVector dq = JointVector::Zero(3);
  JointVector last_momentum = JointVector::Zero(3);
  JointVector last_torque = JointVector::Zero(3);
  for (int k = 0; k < 500; ++k) {
    ticking.set(joints, {ticking.now(), true, false, q, {}});
    ticking.set(drives, {ticking.now(), true, torque});
    ticking.tick();
    const JointVector momentum = ticking.get(velocity.motion).velocity;
    const JointVector filtered = ticking.get(mapping.torque).torque;
    if (k > 0) {
      const JointVector change = (momentum - last_momentum) / T;
      ASSERT_LT((change - 0.5 * (filtered + last_torque)).norm(), 1e-8) << k;
    }
    last_momentum = momentum;
    last_torque = filtered;
    if (k > 3) torque = JointVector::NullaryExpr(3, [&] { return random.uniform(-20.0, 20.0); });
    q += T * dq + 0.5 * T * T * torque;
    dq += T * torque;
  }
}

TEST_P(AlignedTorque, GoesOnAcrossAShortGapAndStartsAnewAfterAnInterruption) {
  for (int missing = 1; missing <= 4; ++missing) {
    Mapping mapping(GetParam());
    for (int k = 0; k < 5; ++k) mapping.see(JointVector::Ones(3));
    for (int k = 0; k < missing; ++k) EXPECT_FALSE(mapping.miss().valid);
    const DriveTorque& torque = mapping.see(JointVector::Constant(3, 5.0));
    EXPECT_TRUE(torque.valid);
    if (missing > 2) {
      EXPECT_EQ(torque.torque, JointVector::Constant(3, 5.0));
    } else {
      EXPECT_GT(torque.torque[0], 1.0);
      EXPECT_LT(torque.torque[0], 4.0);
    }
  }
}

TEST_P(AlignedTorque, DoesNotTakeTheSameReadingTwice) {
  Mapping mapping(GetParam());
  mapping.see(JointVector::Zero(3));
  const JointVector once = mapping.see({1ms, true, JointVector::Ones(3)}).torque;
  EXPECT_EQ(mapping.see({1ms, true, JointVector::Ones(3)}).torque, once);
}

// ---------------------------------------------------------------- cogging

/// A quarter of a wave on, the sine is one and the cosine nothing.
CoggingWave wave() {
  return {JointVector::Constant(3, 0.4), JointVector{{0.3, 0.0, -0.1}}, JointVector{{0.0, 0.2, 0.5}}};
}
Cogging cogging() { return {{wave()}}; }

TEST(DriveTorqueMapping, AddsTheMeanOfTheCoggingOnTheWay) {
  const JointVector current{{1.0, -2.0, 0.5}};
  Mapping mapping(std::nullopt, JointVector::Ones(3), cogging());
  const JointVector start = JointVector::Zero(3), quarter = JointVector::Constant(3, 0.1);
  EXPECT_LT((mapping.see_at(start, current).torque - current - wave().cosine).norm(), 1e-14);
  const JointVector mean = 0.5 * (wave().cosine + wave().sine);
  EXPECT_LT((mapping.see_at(quarter, current).torque - current - mean).norm(), 1e-14);
  EXPECT_LT((mapping.see_at(quarter, current).torque - current - wave().sine).norm(), 1e-14);
}

// The integral over a millisecond at the largest speed of the rig, 24 waves a turn.
TEST(DriveTorqueMapping, KnowsTheMeanOfTheCoggingOfFastDrives) {
  const Cogging waves{{{JointVector::Constant(3, 2.0 * std::numbers::pi / 24.0), JointVector::Ones(3),
                        JointVector::Zero(3)}}};
  Mapping mapping(std::nullopt, JointVector::Ones(3), waves);
  for (double q = -1.0; q < 1.0; q += 8.0 * T) {
    mapping.see_at(JointVector::Constant(3, q), JointVector::Zero(3));
    const double end = q + 8.0 * T, exact = (std::cos(24.0 * q) - std::cos(24.0 * end)) / (24.0 * 8.0 * T);
    const double told = mapping.see_at(JointVector::Constant(3, end), JointVector::Zero(3)).torque[0];
    ASSERT_NEAR(told, exact, 4e-3);
  }
}

TEST(DriveTorqueMapping, KeepsTheCoggingWhileTheEncodersSayNothing) {
  for (const bool starts_silent : {true, false}) {
    Mapping mapping(std::nullopt, JointVector::Ones(3), cogging());
    const JointVector known = starts_silent ? JointVector::Zero(3) : wave().cosine;
    if (!starts_silent) mapping.see_at(JointVector::Zero(3), JointVector::Ones(3));
    const JointReading unusable[] = {{0ms, false, false, JointVector::Constant(3, 0.1), {}},
                                     {0ms, true, false, JointVector::Constant(3, nan), {}},
                                     {0ms, true, false, JointVector::Constant(2, 0.1), {}},
                                     {0ms, true, false, {}, {}}};
    for (const JointReading& reading : unusable) {
      mapping.ticking.set(mapping.joints, reading);
      const DriveTorque& torque = mapping.see(JointVector::Ones(3));
      EXPECT_TRUE(torque.valid);
      EXPECT_LT((torque.torque - JointVector::Ones(3) - known).norm(), 1e-14);
    }
  }
}

// Cogging that a current makes up for is a torque of nothing, and stays so however it is filtered.
TEST_P(AlignedTorque, LagsInItsCoggingAsInItsCurrent) {
  Mapping mapping(GetParam(), JointVector::Ones(3), cogging());
  JointVector last = cogging().at(JointVector::Zero(3));
  for (int k = 0; k < 200; ++k) {
    const JointVector position = JointVector::Constant(3, 3e-3 * k);
    const JointVector here = cogging().at(position);
    ASSERT_LT(mapping.see_at(position, -0.5 * (last + here)).torque.norm(), 1e-14);
    last = here;
  }
}

TEST(DriveTorqueMapping, DoesNotAllocate) {
  Mapping mapping(LowPassForm::tustin, JointVector::Ones(3), cogging());
  const test::AllocationCounter allocations;
  for (int k = 0; k < 20; ++k) mapping.see_at(JointVector::Constant(3, 1e-3 * k), JointVector::Ones(3));
  mapping.miss();
  EXPECT_EQ(allocations.count(), 0);
}

TEST(DriveTorqueMapping, SaysAllThatIsWrongWithItsSettings) {
  const DriveTorqueSettings settings{
      JointVector{{6.1, 0.0}}, {}, {{{JointVector::Zero(3), JointVector::Zero(3), JointVector::Zero(3)}}}};
  try {
    DriveTorqueMapping mapping(rig(), settings, LowPassSettings{0.0, LowPassForm::tustin});
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 4U) << error.what();
  }
}

}  // namespace
}  // namespace flinch
