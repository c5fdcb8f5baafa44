#include "systems/sensors/velocity_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/robot/angles.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double w = 2.0 * pi * 30.0;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

JointReading reading(Time acquired, const JointVector& active) {
  return {.acquired = acquired, .valid = true, .passive_valid = false, .active = active, .passive = {}};
}

JointVector all(double value) { return JointVector::Constant(3, value); }

struct Filter {
  explicit Filter(LowPassForm form = LowPassForm::tustin)
      : block(add(form)), joints(input()), ticking(builder) {}

  const JointMotion& see(const JointReading& joint_reading) {
    ticking.set(joints, joint_reading);
    ticking.tick();
    return ticking.get(block.motion);
  }
  /// A good sample, acquired at the tick.
  const JointMotion& see(const JointVector& active) { return see(reading(ticking.now(), active)); }
  const JointMotion& miss() {
    return see(JointReading{.acquired = ticking.now(), .active = {}, .passive = {}});
  }

  DiagramBuilder builder;
  VelocityFilter& block;
  InputPort<JointReading> joints;
  test::Ticking ticking;

 private:
  VelocityFilter& add(LowPassForm form) {
    const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
    return builder.add<VelocityFilter>("filter", robot, VelocityFilterSettings{{30.0, form}, {}});
  }
  InputPort<JointReading> input() { return builder.export_input("joints", block.joints); }
};

class VelocityFilterOfEitherForm : public testing::TestWithParam<LowPassForm> {
 protected:
  Filter filter_{GetParam()};
  double half_sample_ = GetParam() == LowPassForm::backward_difference ? 0.5e-3 : 0.0;  // of more delay
};
INSTANTIATE_TEST_SUITE_P(VelocityFilter, VelocityFilterOfEitherForm,
                         testing::Values(LowPassForm::tustin, LowPassForm::backward_difference));

TEST_P(VelocityFilterOfEitherForm, IsExactOnARampThroughTheFullCircle) {
  for (int k = 0; k < 3000; ++k) {
    const double angle = wrap_angle(3.0 + 2.5e-3 * k);
    const JointMotion& motion = filter_.see(all(angle));
    ASSERT_EQ(motion.valid, k > 0);
    ASSERT_EQ(motion.position, all(angle));
    if (k > 0) {
      ASSERT_LT((motion.velocity - all(2.5)).norm(), 1e-11) << k;
    }
  }
}

TEST_P(VelocityFilterOfEitherForm, LagsAConstantAccelerationByItsTimeConstant) {
  constexpr double acceleration = 50.0;
  for (int k = 0; k < 300; ++k) {
    const double t = 1e-3 * k;
    const JointMotion& motion = filter_.see(all(wrap_angle(0.5 * acceleration * t * t)));
    if (k > 250) {
      ASSERT_NEAR(motion.velocity[0], acceleration * (t - 1.0 / w - half_sample_), 1e-9);
    }
  }
}

// Steady response of w s / (s + w) to sin(W t): the derivative W cos(W t), attenuated and late. In discrete
// time W becomes (2 / T) tan(W T / 2), and another half sample of the other form averages two neighbours:
// both change the result by less than (W T)^2 / 4 and by the delay of that half sample.
TEST_P(VelocityFilterOfEitherForm, RespondsToASineAsTheContinuousFilterDoes) {
  for (const double frequency : {1.0, 10.0, 30.0}) {
    const double W = 2.0 * pi * frequency;
    Filter filter(GetParam());
    for (int k = 0; k < 1000; ++k) {
      const double t = 1e-3 * k;
      const double velocity = filter.see(all(std::sin(W * t))).velocity[0];
      const double late = t - half_sample_;
      const double expected = W * w * (w * std::cos(W * late) + W * std::sin(W * late)) / (w * w + W * W);
      if (k > 500) {
        ASSERT_NEAR(velocity, expected, 0.25 * W * std::pow(W * 1e-3, 2)) << frequency << " Hz, " << k;
      }
    }
  }
}

TEST(VelocityFilter, HasNoVelocityBeforeTheSecondSample) {
  Filter filter;
  EXPECT_FALSE(filter.miss().valid);
  const JointMotion& first = filter.see(all(1.0));
  EXPECT_FALSE(first.valid);
  EXPECT_EQ(first.velocity, all(0.0));
  const JointMotion& second = filter.see(all(1.002));
  EXPECT_TRUE(second.valid);
  EXPECT_NEAR(second.velocity[0], 2.0, 1e-12);  // the plain difference, not zero
}

TEST(VelocityFilter, HoldsTheMotionForTwoMissingSamplesAndNotForThree) {
  Filter filter;
  filter.see(all(0.0));
  const JointMotion last = filter.see(all(0.001));
  for (int missing = 1; missing <= 2; ++missing) {
    const JointMotion& held = filter.miss();
    EXPECT_TRUE(held.valid) << missing;
    EXPECT_EQ(held.acquired, 1ms);
    EXPECT_EQ(held.velocity, last.velocity);
  }
  const JointMotion& expired = filter.miss();
  EXPECT_FALSE(expired.valid);
  EXPECT_EQ(expired.velocity, all(0.0));
}

TEST(VelocityFilter, DividesByTheTimeBetweenAcquisitionsAcrossAShortGap) {
  for (int missing = 1; missing <= 2; ++missing) {
    Filter filter;
    for (int k = 0; k < 10; ++k) filter.see(all(0.002 * k));
    for (int k = 0; k < missing; ++k) filter.miss();
    const JointMotion& motion = filter.see(all(0.002 * (10 + missing)));
    EXPECT_TRUE(motion.valid);
    EXPECT_NEAR(motion.velocity[0], 2.0, 1e-12);
  }
}

TEST(VelocityFilter, StartsAnewAfterAnInterruption) {
  Filter filter;
  for (int k = 0; k < 10; ++k) filter.see(all(0.002 * k));
  for (int k = 0; k < 3; ++k) filter.miss();
  EXPECT_FALSE(filter.see(all(1.0)).valid);
  const JointMotion& motion = filter.see(all(0.997));
  EXPECT_TRUE(motion.valid);
  EXPECT_NEAR(motion.velocity[0], -3.0, 1e-12);
}

TEST(VelocityFilter, StartsAnewWhereTheTimeOfAcquisitionJumps) {
  Filter filter;
  for (int k = 0; k < 10; ++k) filter.see(all(0.002 * k));
  const Time jump = filter.ticking.now() + 50ms;
  EXPECT_FALSE(filter.see(reading(jump, all(0.02))).valid);
  EXPECT_NEAR(filter.see(reading(jump + 1ms, all(0.022))).velocity[0], 2.0, 1e-12);
}

TEST(VelocityFilter, SkipsWhatIsNotFiniteOfTheWrongSizeOrNotNew) {
  Filter filter;
  filter.see(all(0.0));
  const JointMotion last = filter.see(all(0.001));
  JointVector broken = all(0.002);
  broken[1] = nan;
  const Time now = filter.ticking.now();
  const JointReading unusable[] = {reading(now, broken), reading(now, JointVector::Zero(2)),
                                   reading(1ms, all(0.5)), reading(0ms, all(0.5))};
  for (const JointReading& joint_reading : unusable) {
    Filter copy;
    copy.see(all(0.0));
    copy.see(all(0.001));
    const JointMotion& motion = copy.see(joint_reading);
    EXPECT_TRUE(motion.valid);
    EXPECT_EQ(motion.acquired, 1ms);
    EXPECT_EQ(motion.position, last.position);
    EXPECT_EQ(motion.velocity, last.velocity);
  }
}

TEST(VelocityFilter, IsNeverValidWhenAllThatItSeesIsNotFinite) {
  Filter filter;
  for (int k = 0; k < 10; ++k) {
    const JointMotion& motion = filter.see(all(k % 2 == 0 ? nan : std::numeric_limits<double>::infinity()));
    ASSERT_FALSE(motion.valid);
    ASSERT_TRUE(motion.position.allFinite() && motion.velocity.allFinite());
  }
}

TEST(VelocityFilter, RunsInsideAFasterDiagram) {
  const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
  DiagramBuilder builder("fast", 250us);
  auto& block = builder.add<VelocityFilter>("filter", robot, VelocityFilterSettings{});
  const auto joints = builder.export_input("joints", block.joints);
  test::Ticking ticking(builder);
  for (int k = 0; k < 400; ++k) {
    ticking.set(joints, reading(ticking.now(), all(0.5e-3 * k)));  // 2 rad/s
    ticking.tick();
    if (k > 0) {
      ASSERT_NEAR(ticking.get(block.motion).velocity[0], 2.0, 1e-11) << k;
    }
  }
}

TEST(VelocityFilter, DoesNotAllocate) {
  Filter filter;
  const test::AllocationCounter allocations;
  for (int k = 0; k < 20; ++k) filter.see(all(1e-3 * k));
  for (int k = 0; k < 5; ++k) filter.miss();
  EXPECT_EQ(allocations.count(), 0);
}

TEST(VelocityFilter, AsksForAPositiveCutoffFrequency) {
  const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
  EXPECT_THROW(VelocityFilter(robot, {{-1.0, LowPassForm::tustin}, {}}), SetupError);
}

}  // namespace
}  // namespace flinch
