#include "systems/model/robot_model.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "systems/framework/random.h"
#include "systems/robot/link_segments.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Model {
  Model()
      : block(builder.add<RobotModel>("model", robot)),
        platform(builder.export_input("platform", block.platform)),
        ticking(builder) {}

  void see(const PlatformVector& pose, const PlatformVector& velocity,
           PlatformMotion::Status status = PlatformMotion::Status::valid) {
    ticking.set(platform, {ticking.now(), status, pose, velocity});
    ticking.tick();
  }
  void expect_nothing_valid() const {
    const Kinematics& kinematics = ticking.get(block.kinematics);
    const Dynamics& dynamics = ticking.get(block.dynamics);
    EXPECT_FALSE(kinematics.valid || kinematics.reachable);
    EXPECT_FALSE(dynamics.valid);
    EXPECT_FALSE(ticking.get(block.measures).valid);
    EXPECT_TRUE(kinematics.J_x_qa.allFinite() && dynamics.M_x.allFinite() && dynamics.C_x.allFinite());
  }

  std::shared_ptr<const PlanarRrr> robot =
      std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  DiagramBuilder builder;
  RobotModel& block;
  InputPort<PlatformMotion> platform;
  test::Ticking ticking;
};

TEST(RobotModel, IsTheRobotAtTheMeasuredMotion) {
  Model model;
  RandomGenerator random(1);
  for (int k = 0; k < 100; ++k) {
    const PlatformVector pose{
        {random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), random.uniform(-0.4, 0.4)}};
    const PlatformVector velocity = PlatformVector::NullaryExpr(3, [&] { return random.uniform(-1.0, 1.0); });
    model.see(pose, velocity);
    Kinematics kinematics;
    Dynamics dynamics;
    model.robot->kinematics(pose, velocity, kinematics);
    model.robot->dynamics(kinematics, dynamics);
    ASSERT_TRUE(model.ticking.get(model.block.kinematics).valid);
    ASSERT_TRUE(model.ticking.get(model.block.dynamics).valid);
    ASSERT_EQ(model.ticking.get(model.block.kinematics).dJ_x_qa, kinematics.dJ_x_qa);
    ASSERT_EQ(model.ticking.get(model.block.dynamics).M_x, dynamics.M_x);
    ASSERT_EQ(model.ticking.get(model.block.dynamics).F_fr_x, dynamics.F_fr_x);
    const WorkspaceMeasures& measures = model.ticking.get(model.block.measures);
    ASSERT_TRUE(measures.valid);
    ASSERT_EQ(measures.sigma_kappa, kinematics.sigma_kappa);
    ASSERT_EQ(measures.sigma_sc, self_collision_distance(*model.robot, kinematics));
    ASSERT_EQ(measures.det_A, kinematics.det_A);
    ASSERT_EQ(measures.det_B, kinematics.det_B);
  }
}

// The individual geometry at home, computed apart from this code.
TEST(RobotModel, MeasuresTheHomePose) {
  Model model;
  model.see(PlatformVector::Zero(3), PlatformVector::Zero(3));
  const WorkspaceMeasures& measures = model.ticking.get(model.block.measures);
  EXPECT_TRUE(measures.valid);
  EXPECT_NEAR(measures.sigma_kappa, 7.82, 5e-3);
  EXPECT_NEAR(measures.sigma_sc, 0.18533, 5e-6);
  EXPECT_NEAR(measures.det_A, -0.4519, 5e-5);
  EXPECT_NEAR(measures.det_B, -0.2216, 5e-5);
  EXPECT_NEAR(measures.largest_passive_angle * 180.0 / std::numbers::pi, 124.609, 5e-4);
}

TEST(RobotModel, HasNothingValidToSayOfAMotionThatIsNotValid) {
  using Status = PlatformMotion::Status;
  Model model;
  const PlatformVector zero = PlatformVector::Zero(3);
  for (const Status status :
       {Status::no_data, Status::not_converged, Status::implausible, Status::singular}) {
    model.see(zero, zero);
    model.see(zero, zero, status);
    model.expect_nothing_valid();
  }
}

TEST(RobotModel, HasNothingValidToSayOfWhatTheRobotCannotServe) {
  Model model;
  const PlatformVector zero = PlatformVector::Zero(3);
  const PlatformVector not_finite = PlatformVector::Constant(3, std::numeric_limits<double>::quiet_NaN());
  model.see(not_finite, zero);
  model.expect_nothing_valid();
  model.see(zero, not_finite);
  model.expect_nothing_valid();
  model.see(PlatformVector::Constant(3, 5.0), zero);
  model.expect_nothing_valid();
  model.see({}, {});
  model.expect_nothing_valid();
}

TEST(RobotModel, DoesNotAllocate) {
  Model model;
  const PlatformVector zero = PlatformVector::Zero(3);
  const test::AllocationCounter allocations;
  model.see(zero, zero);
  model.see(zero, zero, PlatformMotion::Status::no_data);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
