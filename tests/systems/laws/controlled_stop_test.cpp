#include "systems/laws/controlled_stop.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_bench.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const TorqueCommand gravity{.computed = {}, .valid = true, .torque = Eigen::Vector3d(1.0, 2.0, -3.0)};
const JointMotion moving{.acquired = {},
                         .valid = true,
                         .position = Eigen::Vector3d::Zero(),
                         .velocity = Eigen::Vector3d(0.5, -1.0, 2.0)};

struct Law {
  Law()
      : block(builder.add<ControlledStop>("stop", test::planar_bench(),
                                          ControlledStopSettings{.damping = 10.0})),
        zero_gravity(builder.export_input("zero_gravity", block.zero_gravity)),
        joints(builder.export_input("joints", block.joints)) {}

  const TorqueCommand& at(const TorqueCommand& compensation, const JointMotion& motion) {
    ticking.set(zero_gravity, compensation);
    ticking.set(joints, motion);
    ticking.tick();
    return ticking.get(block.torque);
  }

  DiagramBuilder builder;
  ControlledStop& block;
  InputPort<TorqueCommand> zero_gravity;
  InputPort<JointMotion> joints;
  test::Ticking ticking{builder};
};

TEST(ControlledStop, DampsEveryDriveAndCompensatesGravity) {
  Law law;
  const TorqueCommand& command = law.at(gravity, moving);
  EXPECT_TRUE(command.valid);
  EXPECT_EQ(command.torque, Eigen::Vector3d(1.0 - 5.0, 2.0 + 10.0, -3.0 - 20.0));
}

TEST(ControlledStop, GoesOnWithTheLastGravityThatWasKnown) {
  Law law;
  law.at(gravity, moving);
  const TorqueCommand& command = law.at({.computed = {}, .valid = false, .torque = {}}, moving);
  EXPECT_TRUE(command.valid);
  EXPECT_EQ(command.torque, Eigen::Vector3d(-4.0, 12.0, -23.0));
}

TEST(ControlledStop, IsNotValidBeforeGravityIsKnown) {
  EXPECT_FALSE(Law().at({.computed = {}, .valid = false, .torque = {}}, moving).valid);
}

TEST(ControlledStop, IsNotValidWithoutRates) {
  Law law;
  law.at(gravity, moving);
  JointMotion lost = moving;
  lost.valid = false;
  EXPECT_FALSE(law.at(gravity, lost).valid);
  lost = moving;
  lost.velocity[1] = nan;
  EXPECT_FALSE(law.at(gravity, lost).valid);
  lost.velocity = Eigen::Vector2d::Zero();
  EXPECT_FALSE(law.at(gravity, lost).valid);
}

TEST(ControlledStop, NeverAllocates) {
  Law law;
  law.at(gravity, moving);
  const test::AllocationCounter counter;
  law.at(gravity, moving);
  EXPECT_EQ(counter.count(), 0);
}

TEST(ControlledStop, RefusesADampingThatIsNotPositive) {
  EXPECT_THROW(ControlledStop(test::planar_bench(), {.damping = 0.0}), SetupError);
  EXPECT_THROW(ControlledStop(test::planar_bench(), {.damping = nan}), SetupError);
}

}  // namespace
}  // namespace flinch
