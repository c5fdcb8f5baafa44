#include "plant/elastic_drives.h"
#include "systems/robot/decompositions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include "plant/general_rig.h"
#include "plant/planar_rig.h"
#include "plant/rig_of.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/plant/moving_rig.h"
#include "tests/plant/random_rig.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

ElasticDrivesSettings springs(int drives, double stiffness, double backlash = 0.0) {
  ElasticDrivesSettings settings{.stiffness = JointVector::Constant(drives, stiffness), .damping_ratio = 0.0};
  if (backlash > 0.0) settings.backlash = JointVector::Constant(drives, backlash);
  return settings;
}

std::shared_ptr<const Hexapod> hexapod() {
  return std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::eccentric, HexapodFriction::none));
}

RigSettings rig(std::shared_ptr<const Mechanism> robot, const ElasticDrivesSettings& elastic) {
  RigSettings settings;
  settings.robot = std::move(robot);
  settings.link_material.reset();
  settings.elastic = elastic;
  return settings;
}

// ---------------------------------------------------------------- energy

double energy(const test::MovingRig& moving) { return moving.now.kinetic_energy + moving.now.elastic_energy; }

/// Largest relative change of the energy of a robot that moves freely.
double energy_drift(const RigSettings& settings, double& most_in_springs, int ticks = 300) {
  test::MovingRig moving(settings);
  const double start = energy(moving);
  double drift = 0.0;
  for (int k = 0; k < ticks; ++k) {
    moving.tick();
    most_in_springs = std::max(most_in_springs, moving.now.elastic_energy / start);
    const double lifted = moving.y[moving.y.size() - 3];  // work of gravity
    drift = std::max(drift, std::abs(energy(moving) - lifted - start) / energy(moving));
  }
  return drift;
}

TEST(ElasticDrives, KeepTheEnergyOfARobotThatNothingActsOn) {
  RigSettings planar = rig(test::individual_rig(), springs(3, 2000.0));
  planar.initial_velocity = PlatformVector{{0.3, -0.4, 1.5}};
  double in_springs = 0.0;
  const double of_planar = energy_drift(planar, in_springs);
  std::cout << "relative drift of the energy: " << of_planar << ", at most " << in_springs << " in springs\n";
  EXPECT_LT(of_planar, 1e-8);
  EXPECT_GT(in_springs, 1e-5);

  RigSettings spatial = rig(hexapod(), springs(6, 2e6));
  spatial.initial_velocity = PlatformVector{{0.1, -0.05, 0.1, 0.3, 0.2, -0.4}};
  constexpr int before_it_has_fallen_out_of_reach = 100;
  EXPECT_LT(energy_drift(spatial, in_springs, before_it_has_fallen_out_of_reach), 1e-8);
}

TEST(ElasticDrives, KeepTheEnergyAlsoWhereTheyHavePlay) {
  RigSettings settings = rig(test::individual_rig(), springs(3, 20000.0, 2e-3));
  settings.initial_velocity = PlatformVector{{0.3, -0.4, 1.5}};
  double in_springs = 0.0;
  EXPECT_LT(energy_drift(settings, in_springs), 1e-6);
  EXPECT_GT(in_springs, 1e-4);
}

TEST(ElasticDrives, LoseEnergyByTheirDamping) {
  RigSettings settings = rig(test::individual_rig(), springs(3, 2000.0));
  settings.elastic.damping_ratio = 0.1;
  test::MovingRig moving(settings);
  moving.y[6] = 0.01;
  moving.tick();
  double before = energy(moving);
  const double start = before;
  for (int k = 0; k < 300; ++k) {
    moving.tick();
    EXPECT_LT(energy(moving), before * (1.0 + 1e-9));
    before = energy(moving);
  }
  EXPECT_LT(before, 0.5 * start);
}

// ---------------------------------------------------------------- motion

/// (M - A^T J A) v' = A^T (tau + J A' v) - C v - g, from the robot's equations as the control path has them.
PlatformVector acceleration_without_rotors(const Mechanism& robot, const Configuration& pose,
                                           const PlatformVector& velocity, const JointVector& rotors,
                                           const JointVector& efforts) {
  Kinematics kinematics;
  Dynamics dynamics;
  robot.kinematics(pose, velocity, kinematics);
  robot.dynamics(kinematics, dynamics);
  const PlatformMatrix& A = kinematics.J_qa_x;
  const PlatformMatrix M = dynamics.M_x - A.transpose() * rotors.asDiagonal() * A;
  const JointVector bias = kinematics.dJ_qa_x * velocity;
  const PlatformVector force = A.transpose() * (efforts + rotors.cwiseProduct(bias)) -
                               dynamics.C_x * velocity - dynamics.g_x - dynamics.F_fr_x;
  return M.ldlt().solve(force);
}

TEST(ElasticDrives, MoveTheRobotAsItsEquationsWithoutRotorsSay) {
  test::RandomRig random(61);
  RigSettings settings = rig(random.shared, springs(3, 5000.0));
  settings.elastic.rotor_inertia = JointVector::Constant(3, 0.12);
  const RigOf<PlanarRig> planar(settings);
  const RigOf<GeneralRig> general(settings);
  const RigStep step = planar.initial_step();
  DriveAction coasting;
  coasting.braked = false;
  for (int i = 0; i < 200; ++i) {
    const PlanarMotion motion = random.motion();
    RigState state = planar.initial_state();
    state.head<3>() = motion.pose;
    state.segment<3>(3) = motion.velocity;
    for (int k = 6; k < 12; ++k) state[k] = random.uniform(-1e-2, 1e-2);
    coasting.torque = Eigen::Vector3d(random.uniform(-20.0, 20.0), 5.0, -3.0);
    RigState rates, of_general;
    planar.rates(state, coasting, PlatformVector::Zero(3), step, rates);
    general.rates(state, coasting, PlatformVector::Zero(3), step, of_general);
    EXPECT_LT((of_general - rates).norm(), 1e-9 * (1.0 + rates.norm()));

    const JointVector passed_on = 5000.0 * state.segment<3>(6);
    const PlatformVector expected = acceleration_without_rotors(*random.shared, motion.pose, motion.velocity,
                                                                settings.elastic.rotor_inertia, passed_on);
    EXPECT_LT((rates.segment<3>(3) - expected).norm(), 1e-9 * (1.0 + expected.norm()));
    const JointVector of_motors = (coasting.torque - passed_on) / 0.12;
    EXPECT_LT((rates.tail<3>() - of_motors).norm(), 1e-9 * (1.0 + of_motors.norm()));
  }
}

TEST(ElasticDrives, SwingWithTheFrequenciesOfMotorsAndLegs) {
  const auto robot = test::individual_rig();
  RigSettings settings = rig(robot, springs(3, 4000.0));
  settings.elastic.rotor_inertia = JointVector::Constant(3, 0.1);
  Kinematics kinematics;
  Dynamics dynamics;
  robot->kinematics(robot->home_pose(), PlatformVector::Zero(3), kinematics);
  robot->dynamics(kinematics, dynamics);
  // Twists phi of free motors and legs: phi'' = -(S + 1/J) k phi with S of the legs without rotors.
  const Eigen::Matrix3d A = kinematics.J_qa_x;
  const Eigen::Matrix3d M = dynamics.M_x - 0.1 * A.transpose() * A;
  const Eigen::Matrix3d S = A * M.inverse() * A.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes(4000.0 *
                                                             (S + 10.0 * Eigen::Matrix3d::Identity()));
  for (int mode = 0; mode < 3; ++mode) {
    test::MovingRig moving(settings);
    const Eigen::Vector3d twist = 1e-6 * modes.eigenvectors().col(mode);
    std::copy_n(twist.data(), 3, moving.y.begin() + 6);
    const double period = 2.0 * std::numbers::pi / std::sqrt(modes.eigenvalues()[mode]);
    for (int k = 0; k < 100; ++k) moving.tick(period / 100);
    const Eigen::Vector3d again = moving.state().segment<3>(6);
    EXPECT_LT((again - twist).norm(), 1e-4 * twist.norm()) << 1.0 / period << " Hz";
  }
}

TEST(ElasticDrives, AsStiffOnesTheRobotMovesAsIfItHadNone) {
  const auto robot = test::individual_rig(RigFriction::test_rig);
  const auto end_of = [&](const ElasticDrivesSettings& elastic) {
    test::MovingRig moving(rig(robot, elastic));
    moving.equation.drives.torque = Eigen::Vector3d(3.0, -4.0, 2.0);
    for (int k = 0; k < 100; ++k) moving.tick();
    return moving.now.pose;
  };
  const Configuration rigid = end_of({});
  const double soft = (end_of(springs(3, 1e4)) - rigid).norm();
  const double stiff = (end_of(springs(3, 1e7)) - rigid).norm();
  EXPECT_GT(soft, 1e-4);
  EXPECT_LT(stiff, 0.01 * soft);
}

// ---------------------------------------------------------------- rest

TEST(ElasticDrives, HoldTheWeightOfARobotFromItsStartOn) {
  test::MovingRig moving(rig(hexapod(), springs(6, 1e5)));
  moving.equation.drives.braked = true;
  const Configuration start = moving.now.pose;
  const double twist = (moving.now.motors - moving.now.joints.active).cwiseAbs().minCoeff();
  EXPECT_GT(twist, 1e-4);
  for (int k = 0; k < 100; ++k) moving.tick();
  EXPECT_LT((moving.now.pose - start).norm(), 0.02 * twist);
}

TEST(ElasticDrives, YieldToAPushWhereBrakesHoldTheMotors) {
  const auto robot = test::individual_rig();
  RigSettings settings = rig(robot, springs(3, 4000.0, 1e-3));
  settings.elastic.damping_ratio = 0.2;
  test::MovingRig moving(settings);
  moving.equation.drives.braked = true;
  moving.equation.applied_wrench = PlatformVector{{30.0, 10.0, 0.0}};
  for (int k = 0; k < 1500; ++k) moving.tick();
  Kinematics at;
  robot->kinematics(moving.now.pose, moving.now.velocity, at);
  const Eigen::Matrix3d A = at.J_qa_x;
  const Eigen::Vector3d effort = A.transpose().lu().solve(Eigen::Vector3d(30.0, 10.0, 0.0));
  for (int i = 0; i < 3; ++i) {
    const double twist = moving.now.joints.active[i] - moving.now.motors[i];
    EXPECT_NEAR(twist, effort[i] / 4000.0 + std::copysign(5e-4, effort[i]), 2e-5);
  }
}

TEST(ElasticDrives, RestUnderTheirBrakesWhereNothingMoves) {
  test::MovingRig moving(rig(test::individual_rig(), springs(3, 4000.0)));
  moving.equation.drives.braked = true;
  moving.equation.drives.torque.setZero(3);
  moving.tick();
  EXPECT_TRUE(moving.now.at_rest);
  moving.y[6] += 1e-3;
  moving.tick();
  moving.tick();
  EXPECT_FALSE(moving.now.at_rest);
}

// ---------------------------------------------------------------- settings

TEST(ElasticDrives, PassNothingOnBetweenTheirFlanksAndNeverPull) {
  const auto robot = test::individual_rig();
  ElasticDrivesSettings settings = springs(3, 1000.0, 0.01);
  settings.damping_ratio = 0.5;
  const ElasticDrives drives(settings, *robot, robot->home_pose());
  EXPECT_EQ(drives.effort(0, 0.004, 10.0), 0.0);
  EXPECT_DOUBLE_EQ(drives.effort(0, 0.007, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(drives.effort(2, -0.008, 0.0), -3.0);
  EXPECT_EQ(drives.effort(0, 0.0051, -10.0), 0.0);
  EXPECT_GT(drives.effort(0, 0.007, 0.1), 2.0);
  EXPECT_FALSE(ElasticDrives().any());
}

TEST(ElasticDrives, TellWhatIsWrongWithThem) {
  const auto robot = test::individual_rig();
  const auto problems_of = [&](const ElasticDrivesSettings& settings) {
    return problems(settings, *robot, robot->home_pose());
  };
  EXPECT_THAT(problems_of({}), ElementsAre());
  EXPECT_THAT(problems_of(springs(2, 1000.0)),
              ElementsAre(HasSubstr("stiffness needs a positive number for each of the 3 drives")));
  EXPECT_THAT(problems_of(springs(3, -1.0)), ElementsAre(HasSubstr("elastic_drives.stiffness")));
  ElasticDrivesSettings heavy = springs(3, 1000.0);
  heavy.rotor_inertia = JointVector::Constant(3, 0.7);
  EXPECT_THAT(problems_of(heavy), ElementsAre(HasSubstr("rotor_inertia is more than all that a drive moves, "
                                                        "0.5")));
  RigSettings settings = rig(robot, heavy);
  EXPECT_THAT(problems(settings), ElementsAre(HasSubstr("elastic_drives.rotor_inertia")));
}

}  // namespace
}  // namespace flinch
