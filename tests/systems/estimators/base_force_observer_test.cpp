#include "systems/estimators/base_force_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "systems/foundation/setup_error.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/planar_leg_bases.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

using Eigen::Vector2d;

/// The planar rig, held at home by its drives against a push on a link.
struct Held {
  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
  std::shared_ptr<const LegBases> bases =
      std::make_shared<const PlanarLegBases>(robot, std::array<double, 3>{1.1, 1.1, 1.1});
  Kinematics at = test::at_home(*robot);
  ForceOnBody push;
  JointVector torque;
  BaseForces borne, felt;

  Held() {
    const BodyId link = BodyId::link2(1);
    const CartesianVector point = robot->axis_point(link, 0.3);
    push = {link.index(), robot->point_on_body(at, link, point), Vector2d(12.0, -30.0)};
    const PlatformVector wrench =
        platform_wrench(robot->contact_jacobian(at, link, point), push.force_in_base);
    torque = -drive_torques(at, wrench);
    bases->forces(at, PlatformVector::Zero(3), torque, {&push, 1}, borne);
    felt.setZero(6);
    felt.segment<2>(2) = bases->felt(at, link, push.point_in_base, push.force_in_base);
  }
};

struct Block {
  explicit Block(const std::shared_ptr<const LegBases>& bases, const BaseForceObserverSettings& settings = {})
      : block(builder.add<BaseForceObserver>("observer", bases, settings)),
        platform(builder.export_input("platform", block.platform)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        torque(builder.export_input("torque", block.torque)),
        forces(builder.export_input("forces", block.forces)),
        ticking(builder) {}

  BaseForceEstimate see(const Held& held, bool touched, bool valid = true, bool braked = false) {
    const Time now = ticking.now();
    PlatformMotion motion;
    motion.acquired = now;
    motion.status = PlatformMotion::Status::valid;
    DriveTorque drives;
    drives.acquired = now;
    drives.valid = true;
    drives.braked = braked;
    drives.torque = touched ? held.torque : JointVector(JointVector::Zero(3));
    BaseForceReading reading;
    reading.acquired = now;
    reading.valid = valid;
    reading.force_in_base = touched ? held.borne : BaseForces(BaseForces::Zero(6));
    ticking.set(platform, motion);
    ticking.set(kinematics, held.at);
    ticking.set(torque, drives);
    ticking.set(forces, reading);
    ticking.tick();
    return ticking.get(block.estimate);
  }

  DiagramBuilder builder{"test", 1ms};
  BaseForceObserver& block;
  InputPort<PlatformMotion> platform;
  InputPort<Kinematics> kinematics;
  InputPort<DriveTorque> torque;
  InputPort<BaseForceReading> forces;
  test::Ticking ticking;
};

TEST(BaseForceObserver, GoesToWhatAPushLeavesAtTheBasesOfItsLegAlone) {
  const Held held;
  Block observer(held.bases);
  for (int k = 0; k < 100; ++k) observer.see(held, false);
  const test::AllocationCounter allocations;
  BaseForceEstimate estimate;
  for (int k = 0; k < 100; ++k) estimate = observer.see(held, true);
  EXPECT_EQ(allocations.count(), 0);
  ASSERT_TRUE(estimate.valid);
  EXPECT_LT((estimate.force_in_base - held.felt).norm(), 1e-3 * held.felt.norm());
  EXPECT_LT(estimate.force_in_base.head<2>().norm() + estimate.force_in_base.tail<2>().norm(), 1e-9);
}

TEST(BaseForceObserver, FollowsAStepAsAFirstOrderLag) {
  const Held held;
  Block observer(held.bases, {.gain = 50.0});
  for (int k = 0; k < 150; ++k) observer.see(held, false);
  observer.see(held, true);  // half of the first interval
  double left = 1.0 - 0.5 * -std::expm1(-0.05);
  for (int k = 0; k < 20; ++k) {
    const BaseForceEstimate estimate = observer.see(held, true);
    left *= std::exp(-0.05);
    EXPECT_LT((estimate.force_in_base - (1.0 - left) * held.felt).norm(), 1e-9 * held.felt.norm());
  }
}

TEST(BaseForceObserver, BeginsAnewAfterAGapAndUnderBrakes) {
  const Held held;
  Block observer(held.bases);
  for (int k = 0; k < 150; ++k) observer.see(held, true);
  EXPECT_TRUE(observer.see(held, true, false).valid) << "one reading is missing";
  EXPECT_TRUE(observer.see(held, true, false).valid);
  observer.see(held, true, false);
  EXPECT_FALSE(observer.see(held, true, false).valid);
  EXPECT_FALSE(observer.see(held, true).valid) << "it settles";
  for (int k = 0; k < 150; ++k) observer.see(held, true);
  EXPECT_TRUE(observer.see(held, true).valid);
  const BaseForceEstimate braked = observer.see(held, true, true, true);
  EXPECT_FALSE(braked.valid);
  EXPECT_EQ(braked.force_in_base, BaseForces(BaseForces::Zero(6)));
}

TEST(BaseForceObserver, LeavesOutWhatIsNoNumber) {
  Held held;
  Block observer(held.bases);
  for (int k = 0; k < 150; ++k) observer.see(held, true);
  const BaseForces before = observer.see(held, true).force_in_base;
  Held broken = held;
  broken.borne[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(observer.see(broken, true).force_in_base, before);
  EXPECT_TRUE(observer.see(held, true).force_in_base.allFinite());
}

TEST(BaseForceObserver, AsksForBasesAndAGain) {
  EXPECT_THROW(BaseForceObserver(nullptr, {}), SetupError);
  EXPECT_THROW(BaseForceObserver(Held().bases, {.gain = 0.0}), SetupError);
}

}  // namespace
}  // namespace flinch
