#include "systems/model/forward_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/smooth_trajectory.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using Status = PlatformMotion::Status;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const PlanarRrr> rig(RigGeometry geometry = RigGeometry::individual) {
  return std::make_shared<PlanarRrr>(rig_robot(geometry, RigFriction::none));
}

/// What the joints show at a pose.
struct Joints {
  JointMotion motion;
  JointReading reading;
};

Joints joints_at(const ParallelRobot& robot, const PlatformVector& pose, const PlatformVector& velocity,
                 Time now) {
  Kinematics kinematics;
  robot.kinematics(pose, velocity, kinematics);
  const auto& [active, passive, coupling] = kinematics.joints;
  return {{now, true, active, kinematics.rates.active}, {now, true, true, active, passive}};
}

struct Solver {
  explicit Solver(const ForwardKinematicsSettings& settings = {},
                  std::shared_ptr<const PlanarRrr> solved = rig())
      : robot(std::move(solved)),
        block(builder.add<ForwardKinematics>("kinematics", robot, settings)),
        motion(builder.export_input("motion", block.motion)),
        joints(builder.export_input("joints", block.joints)),
        ticking(builder) {}

  const PlatformMotion& see(const Joints& seen) {
    ticking.set(motion, seen.motion);
    ticking.set(joints, seen.reading);
    ticking.tick();
    return ticking.get(block.platform);
  }
  /// What the joints show at a pose now.
  Joints at(const PlatformVector& pose, const PlatformVector& velocity = PlatformVector::Zero(3)) const {
    return joints_at(*robot, pose, velocity, ticking.now());
  }

  std::shared_ptr<const PlanarRrr> robot;
  DiagramBuilder builder;
  ForwardKinematics& block;
  InputPort<JointMotion> motion;
  InputPort<JointReading> joints;
  test::Ticking ticking;
};

const PlatformVector somewhere{{0.05, -0.08, 0.1}};

class ForwardKinematicsFromEitherStart : public testing::TestWithParam<ForwardKinematicsStart> {
 protected:
  ForwardKinematicsSettings settings() const {
    return {.start = GetParam(), .initial_pose = {}, .sampling = {}};
  }
};
INSTANTIATE_TEST_SUITE_P(ForwardKinematics, ForwardKinematicsFromEitherStart,
                         testing::Values(ForwardKinematicsStart::previous_pose,
                                         ForwardKinematicsStart::passive_angles));

TEST_P(ForwardKinematicsFromEitherStart, RecoversPoseAndVelocityOfAMotion) {
  Solver solver(settings());
  for (int k = 0; k < 1000; ++k) {
    const test::SmoothTrajectory truth(1e-3 * k);
    const PlatformMotion& platform = solver.see(solver.at(truth.pose, truth.velocity));
    ASSERT_EQ(platform.status, Status::valid) << k;
    ASSERT_LT((platform.pose - truth.pose).norm(), 1e-9);
    ASSERT_LT((platform.velocity - truth.velocity).norm(), 1e-8);
  }
}

TEST_P(ForwardKinematicsFromEitherStart, RecoversRandomPosesEachFromItsOwnPassiveAnglesInSpiteOfTheirErrors) {
  RandomGenerator random(1);
  for (int k = 0; k < 300; ++k) {
    Solver solver(settings());
    const PlatformVector pose{
        {random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15), random.uniform(-0.3, 0.3)}};
    Joints joints = solver.at(pose);
    for (double& angle : joints.reading.passive) angle += 0.1 * std::numbers::pi / 180.0 * random.normal();
    const PlatformMotion& platform = solver.see(joints);
    ASSERT_EQ(platform.status, Status::valid) << k;
    ASSERT_LT(solver.robot->difference(platform.pose, pose).norm(), 1e-8);
  }
}

TEST_P(ForwardKinematicsFromEitherStart, NeedsNoPassiveAnglesOnceItHasAPose) {
  Solver solver(settings());
  for (int k = 0; k < 100; ++k) {
    const test::SmoothTrajectory truth(1e-3 * k);
    Joints joints = solver.at(truth.pose, truth.velocity);
    joints.reading.passive_valid = k == 0;
    const PlatformMotion& platform = solver.see(joints);
    ASSERT_EQ(platform.status, Status::valid) << k;
    ASSERT_LT((platform.pose - truth.pose).norm(), 1e-9);
  }
}

TEST_P(ForwardKinematicsFromEitherStart, HasNoPoseWithNeitherAPreviousOneNorPassiveAngles) {
  Solver solver(settings());
  Joints joints = solver.at(somewhere);
  joints.reading.passive_valid = false;
  EXPECT_EQ(solver.see(joints).status, Status::no_data);
}

TEST_P(ForwardKinematicsFromEitherStart, StartsFromTheInitialPoseIfToldTo) {
  ForwardKinematicsSettings from_home = settings();
  from_home.initial_pose = PlatformVector::Zero(3);
  Solver solver(from_home);
  Joints joints = solver.at(somewhere);
  joints.reading.passive_valid = false;
  const PlatformMotion& platform = solver.see(joints);
  EXPECT_EQ(platform.status, Status::valid);
  EXPECT_LT((platform.pose - somewhere).norm(), 1e-9);
}

TEST(ForwardKinematics, ForgetsAPoseThatIsTooOldToStartFrom) {
  Solver solver;
  ASSERT_EQ(solver.see(solver.at(somewhere)).status, Status::valid);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(solver.see({}).status, Status::no_data);
  Joints joints = solver.at(somewhere);
  joints.reading.passive_valid = false;
  EXPECT_EQ(solver.see(joints).status, Status::no_data);
  EXPECT_EQ(solver.see(solver.at(somewhere)).status, Status::valid);
}

TEST(ForwardKinematics, DoesNotConvergeForAnglesThatNoPoseHas) {
  Solver solver;
  Joints joints = solver.at(somewhere);
  joints.motion.position.array() += std::numbers::pi;  // all elbows outwards
  joints.reading.active = joints.motion.position;
  const PlatformMotion& platform = solver.see(joints);
  EXPECT_EQ(platform.status, Status::not_converged);
  EXPECT_EQ(platform.pose, PlatformVector::Zero(3));
  EXPECT_EQ(platform.velocity, PlatformVector::Zero(3));
}

TEST(ForwardKinematics, TellsThatActiveAndPassiveEncodersContradictEachOtherBeyondTheLargestError) {
  const auto robot = rig();
  RandomGenerator random(2);
  for (int k = 0; k < 50; ++k) {
    Joints joints = joints_at(*robot, somewhere, PlatformVector{{0.3, 0.2, 0.1}}, 0ms);
    joints.reading.passive[k % 3] += random.uniform(-0.3, 0.3);
    const double error =
        robot->chain_closure_error(joints.motion.position, joints.reading.passive, somewhere);
    ForwardKinematicsSettings settings;
    settings.largest_closure_error = 1.0001 * error;
    EXPECT_EQ(Solver(settings, robot).see(joints).status, Status::valid);
    settings.largest_closure_error = 0.9999 * error;
    const PlatformMotion platform = Solver(settings, robot).see(joints);
    EXPECT_EQ(platform.status, Status::implausible);
    EXPECT_EQ(platform.velocity, PlatformVector::Zero(3));
  }
}

TEST(ForwardKinematics, AllowsOneCentimetreByDefault) {
  Solver solver;
  Joints joints = solver.at(PlatformVector::Zero(3));
  joints.reading.passive[0] += 0.01;  // 0.62 m away from the elbow
  EXPECT_EQ(solver.see(joints).status, Status::valid);
  joints = solver.at(PlatformVector::Zero(3));
  joints.reading.passive[0] += 0.03;
  EXPECT_EQ(solver.see(joints).status, Status::implausible);
}

TEST(ForwardKinematics, TellsThatAnElbowHasChangedSides) {
  Solver solver;
  WorkingMode mode = solver.robot->home_working_mode();
  mode[1] = 1 - mode[1];
  Kinematics kinematics;
  solver.robot->kinematics(somewhere, PlatformVector::Zero(3), mode, kinematics);
  ASSERT_TRUE(kinematics.reachable);
  const auto& [active, passive, coupling] = kinematics.joints;
  const PlatformMotion& platform =
      solver.see({{0ms, true, active, JointVector::Zero(3)}, {0ms, true, true, active, passive}});
  EXPECT_FALSE(platform.valid());
}

// From starts and poses on both sides of singularities.
TEST(ForwardKinematics, TellsAJumpToAnotherBranchAlsoWithoutPassiveAngles) {
  const auto robot = rig();
  RandomGenerator random(3);
  int jumps = 0;
  for (int k = 0; k < 2000; ++k) {
    const auto draw = [&] {
      return PlatformVector{
          {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-2.0, 2.0)}};
    };
    const PlatformVector start = draw();
    Joints joints = joints_at(*robot, draw(), PlatformVector::Ones(3), 0ms);
    joints.reading.passive_valid = false;
    if (!robot->inverse_kinematics(start, robot->home_working_mode()).reachable) continue;
    ForwardKinematicsSettings settings;
    settings.initial_pose = start;
    const PlatformMotion platform = Solver(settings, robot).see(joints);
    Kinematics at_start, found;
    robot->kinematics(start, PlatformVector::Zero(3), at_start);
    robot->kinematics(platform.pose, PlatformVector::Zero(3), found);
    const bool jumped = at_start.det_A * found.det_A < 0.0;
    EXPECT_FALSE(platform.valid() && jumped);
    if (platform.status != Status::implausible) continue;
    ++jumps;
    EXPECT_TRUE(jumped);
    EXPECT_EQ(platform.velocity, PlatformVector::Zero(3));
  }
  EXPECT_GT(jumps, 50);
}

TEST(ForwardKinematics, DoesNotJudgeByPassiveAnglesOfAnotherTime) {
  Solver solver;
  ASSERT_EQ(solver.see(solver.at(somewhere)).status, Status::valid);
  Joints joints = solver.at(somewhere);
  joints.reading.acquired += 1ms;
  joints.reading.passive.setZero();
  EXPECT_EQ(solver.see(joints).status, Status::valid);
}

// A microradian from it: the pose still converges, but the velocity would have no digits left.
TEST(ForwardKinematics, HasNoVelocityNextToASingularity) {
  Solver solver({}, rig(RigGeometry::nominal));
  const auto det_A = [&](double phi) {
    Kinematics kinematics;
    solver.robot->kinematics(PlatformVector{{0.0, 0.0, phi}}, PlatformVector::Zero(3), kinematics);
    return kinematics.det_A;
  };
  double regular = 0.0;
  double beyond = 1.2;
  ASSERT_LT(det_A(regular) * det_A(beyond), 0.0);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (regular + beyond);
    (det_A(regular) * det_A(middle) > 0.0 ? regular : beyond) = middle;
  }
  const PlatformVector pose{{0.0, 0.0, regular - 1e-6}};
  Joints joints = solver.at(pose);
  joints.motion.velocity.setOnes();
  const PlatformMotion& platform = solver.see(joints);
  EXPECT_EQ(platform.status, Status::singular);
  EXPECT_LT((platform.pose - pose).norm(), 1e-6);
  EXPECT_EQ(platform.velocity, PlatformVector::Zero(3));
}

TEST(ForwardKinematics, NeverCallsWhatIsNotFiniteValid) {
  for (int broken = 0; broken < 9; ++broken) {
    Solver solver;
    Joints joints = solver.at(somewhere);
    JointVector* const vectors[] = {&joints.motion.position, &joints.motion.velocity,
                                    &joints.reading.passive};
    (*vectors[broken / 3])[broken % 3] = nan;
    const PlatformMotion& platform = solver.see(joints);
    EXPECT_FALSE(platform.valid()) << broken;
    EXPECT_TRUE(platform.pose.allFinite() && platform.velocity.allFinite()) << broken;
  }
}

TEST(ForwardKinematics, HasNoDataWhereTheJointMotionIsNotValid) {
  Solver solver;
  ASSERT_EQ(solver.see(solver.at(somewhere)).status, Status::valid);
  Joints joints = solver.at(somewhere);
  joints.motion.valid = false;
  EXPECT_EQ(solver.see(joints).status, Status::no_data);
}

TEST(ForwardKinematics, DoesNotAllocate) {
  Solver solver;
  const Joints good = solver.at(somewhere);
  Joints bad = good;
  bad.motion.position.array() += std::numbers::pi;
  const test::AllocationCounter allocations;
  for (int k = 0; k < 10; ++k) solver.see(good);
  for (int k = 0; k < 10; ++k) solver.see(bad);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(ForwardKinematics, SaysAllThatIsWrongWithItsSettings) {
  ForwardKinematicsSettings settings;
  settings.initial_pose = PlatformVector{{5.0, 0.0, 0.0}};
  settings.largest_closure_error = 0.0;
  try {
    ForwardKinematics kinematics(rig(), settings);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U) << error.what();
  }
}

}  // namespace
}  // namespace flinch
