#include "systems/laws/safety_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/link_segments.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using Use = SafetyFilterSettings::Use;

constexpr double degree = std::numbers::pi / 180.0;

SafetyFilterSettings always() {
  SafetyFilterSettings settings;
  settings.use = Use::always;
  return settings;
}

/// Those of [SafePR] and of the rig.
SafetyFilterSettings strict_settings() {
  SafetyFilterSettings settings = always();
  settings.limits.workspace = {.centre = {},
                               .max_distance = 0.3,
                               .max_rotation = 25.0 * degree,
                               .min_abs_det_A = 0.2,
                               .min_abs_det_B = 0.15,
                               .min_self_collision_distance = 0.12,
                               .min_active = -35.0 * degree,
                               .max_active = 150.0 * degree};
  settings.limits.max_condition_number = 15.0;
  settings.max_platform_speed = 2.1;
  settings.max_drive_speed = 7.6;
  settings.max_torque_rate = 100e3;  // a limit that asks for more than the rate lets through needs slack
  return settings;
}

/// A safety filter before a robot that does what its model says, and drives that are told what it hands on.
struct Kept {
  explicit Kept(const SafetyFilterSettings& settings, bool obeyed = true)
      : block(builder.add<SafetyFilter>("limits", robot, settings)),
        request(builder.export_input("request", block.request)),
        motion(builder.export_input("motion", block.motion)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        dynamics(builder.export_input("dynamics", block.dynamics)),
        disturbance(builder.export_input("disturbance", block.disturbance)),
        commanded(connect_drives(obeyed)) {}

  void stand_at(const PlatformVector& where, const PlatformVector& moving) {
    pose = where, velocity = moving;
  }

  const TorqueCommand& ask(const JointVector& torque) {
    Kinematics k;
    Dynamics d;
    robot->kinematics(pose, velocity, k);
    robot->dynamics(k, d);
    ticking.set(motion, PlatformMotion{
                            .acquired = ticking.now(), .status = status, .pose = pose, .velocity = velocity});
    ticking.set(kinematics, k);
    ticking.set(dynamics, d);
    WrenchEstimate pushed;
    pushed.valid = true;
    pushed.wrench_in_base = push;
    ticking.set(disturbance, pushed);
    ticking.set(request, TorqueCommand{.computed = ticking.now(), .valid = true, .torque = torque});
    ticking.tick();
    return ticking.get(block.torque);
  }

  /// A millisecond under the torques that are handed on, by the rule of Runge and Kutta.
  void move(const JointVector& torque) {
    const JointVector held = ask(torque).torque;
    constexpr double T = 1e-3;
    const auto slope = [&](const Eigen::Matrix<double, 6, 1>& x) {
      Kinematics k;
      Dynamics d;
      robot->kinematics(x.head<3>(), x.tail<3>(), k);
      robot->dynamics(k, d);
      Eigen::Matrix<double, 6, 1> dx;
      dx << x.tail<3>(), *forward_dynamics(k, d, held, push);
      return dx;
    };
    Eigen::Matrix<double, 6, 1> x;
    x << pose, velocity;
    const auto k1 = slope(x);
    const auto k2 = slope(x + 0.5 * T * k1);
    const auto k3 = slope(x + 0.5 * T * k2);
    const auto k4 = slope(x + T * k3);
    x += T / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    pose = x.head<3>();
    velocity = x.tail<3>();
  }

  Kinematics now() const {
    Kinematics k;
    robot->kinematics(pose, velocity, k);
    return k;
  }

  InputPort<TorqueCommand> connect_drives(bool obeyed) {
    if (!obeyed) return builder.export_input("commanded", block.commanded);
    builder.connect(block.torque, block.commanded);
    return block.commanded;
  }

  std::shared_ptr<const PlanarRrr> robot = test::planar_rig();
  DiagramBuilder builder;
  SafetyFilter& block;
  InputPort<TorqueCommand> request;
  InputPort<PlatformMotion> motion;
  InputPort<Kinematics> kinematics;
  InputPort<Dynamics> dynamics;
  InputPort<WrenchEstimate> disturbance;
  InputPort<TorqueCommand> commanded;
  test::Ticking ticking{builder};
  PlatformVector pose = PlatformVector::Zero(3);
  PlatformVector velocity = PlatformVector::Zero(3);
  PlatformVector push = PlatformVector::Zero(3);
  PlatformMotion::Status status = PlatformMotion::Status::valid;
};

bool equal(const JointVector& a, const JointVector& b) { return a == b; }

TEST(SafetyFilter, HandsOnARequestThatBreaksNoLimitBitForBit) {
  Kept kept(strict_settings());
  const Eigen::Vector3d torque(1.0 / 3.0, -2.0, 0.7);
  EXPECT_TRUE(equal(kept.ask(torque).torque, torque));
  const LimitStatus& status = kept.ticking.get(kept.block.status);
  EXPECT_TRUE(status.keeping && status.valid);
  EXPECT_EQ(status.steps, 0);
}

TEST(SafetyFilter, KeepsEveryLimitWhateverIsAsked) {
  const SafetyFilterSettings settings = strict_settings();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double sigma_kappa = 0.0, sigma_sc = 1.0, distance = 0.0, rotation = 0.0, speed = 0.0, slack = 0.0;
  int most_steps = 0, bound = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Kept kept(settings);
    kept.stand_at(Eigen::Vector3d(0.08 * unit(random), 0.08 * unit(random), 0.1 * unit(random)),
                  Eigen::Vector3d(unit(random), unit(random), unit(random)));
    Eigen::Vector3d torque;
    for (int tick = 0; tick < 600; ++tick) {
      if (tick % 150 == 0) torque = 100.0 * Eigen::Vector3d(unit(random), unit(random), unit(random));
      kept.move(torque);
      const Kinematics k = kept.now();
      ASSERT_TRUE(k.valid);
      const LimitStatus& status = kept.ticking.get(kept.block.status);
      ASSERT_TRUE(status.valid);
      sigma_kappa = std::max(sigma_kappa, k.sigma_kappa);
      sigma_sc = std::min(sigma_sc, self_collision_distance(*kept.robot, k));
      distance = std::max(distance, kept.pose.head<2>().norm());
      rotation = std::max(rotation, std::abs(kept.pose[2]));
      speed = std::max(speed, kept.velocity.head<2>().norm());
      slack = std::max(slack, status.slack);
      most_steps = std::max(most_steps, status.steps);
      bound += status.binding != 0 ? 1 : 0;
    }
  }
  RecordProperty("most_steps", most_steps);
  EXPECT_GT(bound, 1000) << "the limits were reached";
  EXPECT_LT(sigma_kappa, 15.0);
  EXPECT_GT(sigma_sc, 0.12);
  EXPECT_LT(distance, 0.3);
  EXPECT_LT(rotation, 25.0 * degree);
  EXPECT_LT(speed, 1.01 * 2.1) << "the torque is held for a tick";
  EXPECT_LT(slack, 1e-9);
  EXPECT_LE(most_steps, 20);
}

TEST(SafetyFilter, ChangesTheMotionAsAFrictionlessWallDoes) {
  // At the border, pressed outwards: the force of the limit has no share along it.
  SafetyFilterSettings settings = always();
  settings.limits.workspace.max_distance = 0.2;
  Kept kept(settings);
  kept.stand_at(Eigen::Vector3d(0.2 - settings.margins.distance, 0.0, 0.0), Eigen::Vector3d::Zero());
  const Eigen::Matrix3d J_T = kept.now().J_qa_x.transpose();
  const Eigen::Vector3d outwards(20.0, 10.0, 0.3);
  const JointVector wanted = J_T.inverse() * outwards;
  const Eigen::Vector3d force = J_T * kept.ask(wanted).torque - outwards;
  EXPECT_LT(force[0], -1.0);
  EXPECT_NEAR(force[1], 0.0, 1e-4 * std::abs(force[0]));
  EXPECT_NEAR(force[2], 0.0, 1e-4 * std::abs(force[0]));
}

TEST(SafetyFilter, HoldsAgainstWhatPushesTheRobotOut) {
  SafetyFilterSettings settings = always();
  settings.limits.workspace.max_distance = 0.2;
  Kept kept(settings);
  kept.push = Eigen::Vector3d(40.0, 0.0, 0.0);
  for (int tick = 0; tick < 1000; ++tick) kept.move(-20.0 * kept.now().rates.active);
  EXPECT_LT(kept.pose.head<2>().norm(), 0.2);
  EXPECT_GT(kept.pose.head<2>().norm(), 0.19);
  EXPECT_LT(std::abs(kept.velocity[0]), 5e-3);
}

// Rotation counts on 6 % of what the drives can do; 15 rad/s at 5 degrees need ten times as much.
TEST(SafetyFilter, BrakesHarderWhereARobotWasPushedTooFastAndNeedsNoSlackForThat) {
  SafetyFilterSettings settings = always();
  settings.limits.workspace.max_rotation = 25.0 * degree;
  Kept kept(settings);
  kept.stand_at(Eigen::Vector3d(0.0, 0.0, 5.0 * degree), Eigen::Vector3d(0.0, 0.0, 15.0));
  double rotation = 0.0, slack = 0.0, torque = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    kept.move(Eigen::Vector3d::Zero());
    torque = std::max(torque, kept.ticking.get(kept.block.torque).torque.lpNorm<Eigen::Infinity>());
    rotation = std::max(rotation, kept.pose[2]);
    slack = std::max(slack, kept.ticking.get(kept.block.status).slack);
  }
  EXPECT_LT(rotation, 25.0 * degree);
  EXPECT_GT(torque, 99.9);
  EXPECT_LT(slack, 1e-9);
}

TEST(SafetyFilter, LetsARobotThatStandsOutsideStayWhereItIsAndGetNoFurther) {
  SafetyFilterSettings settings = always();
  settings.limits.workspace.max_distance = 0.2;
  Kept kept(settings);
  kept.stand_at(Eigen::Vector3d(0.25, 0.0, 0.0), Eigen::Vector3d::Zero());
  for (int tick = 0; tick < 300; ++tick) kept.move(Eigen::Vector3d::Zero());
  EXPECT_NEAR(kept.pose[0], 0.25, 1e-9);
  kept.push = Eigen::Vector3d(40.0, 0.0, 0.0);
  for (int tick = 0; tick < 300; ++tick) kept.move(-20.0 * kept.now().rates.active);
  EXPECT_LT(kept.pose[0], 0.2505);
  kept.push = Eigen::Vector3d(-40.0, 0.0, 0.0);
  for (int tick = 0; tick < 100; ++tick) kept.move(-20.0 * kept.now().rates.active);
  const double further_in = kept.pose[0];
  EXPECT_LT(further_in, 0.245);
  kept.push = Eigen::Vector3d(40.0, 0.0, 0.0);
  for (int tick = 0; tick < 300; ++tick) kept.move(-20.0 * kept.now().rates.active);
  EXPECT_LT(kept.pose[0], std::max(further_in, 0.2) + 1e-3) << "the limit has closed behind it";
}

TEST(SafetyFilter, BoundsTorquesAndTheirRates) {
  SafetyFilterSettings settings = always();
  settings.max_torque = 50.0;
  settings.max_torque_rate = 10e3;
  Kept kept(settings);
  kept.ask(Eigen::Vector3d::Zero());
  EXPECT_TRUE(
      kept.ask(Eigen::Vector3d(80.0, -80.0, 5.0)).torque.isApprox(Eigen::Vector3d(10.0, -10.0, 5.0), 1e-6));
  for (int tick = 0; tick < 10; ++tick) kept.ask(Eigen::Vector3d(80.0, -80.0, 5.0));
  EXPECT_LE(kept.ticking.get(kept.block.torque).torque.lpNorm<Eigen::Infinity>(), 50.0);
}

// Three quarters of max_torque_rate / max_torque: 150 1/s for these drives, 37.5 1/s for slow ones.
TEST(SafetyFilter, CountsOnNoDriveBeingFasterThanItIs) {
  const auto asked = [](double torque_rate, double correction) {
    SafetyFilterSettings settings = strict_settings();
    settings.max_torque = 100.0;
    settings.max_torque_rate = torque_rate;
    settings.correction = correction;
    Kept kept(settings);
    kept.stand_at(Eigen::Vector3d(0.28, 0.0, 0.0), Eigen::Vector3d(1.5, 0.0, 0.0));
    return JointVector(kept.ask(Eigen::Vector3d::Zero()).torque);
  };
  EXPECT_EQ(asked(5e3, 1e6), asked(5e3, 37.5));
  EXPECT_EQ(asked(20e3, 1e6), asked(20e3, 150.0));
  EXPECT_NE(asked(20e3, 150.0), asked(20e3, 37.5));
}

TEST(SafetyFilter, KeepsLimitsWhileThereIsAMotion) {
  const Eigen::Vector3d outwards(90.0, -90.0, 90.0);
  const auto keeps = [&](PlatformMotion::Status status) {
    Kept kept(strict_settings());
    kept.stand_at(Eigen::Vector3d(0.28, 0.0, 0.0), Eigen::Vector3d(1.5, 0.0, 0.0));
    kept.status = status;
    kept.ask(outwards);
    return kept.ticking.get(kept.block.status).keeping;
  };
  EXPECT_FALSE(keeps(PlatformMotion::Status::no_data));
  EXPECT_TRUE(keeps(PlatformMotion::Status::valid));
  EXPECT_TRUE(keeps(PlatformMotion::Status::not_converged)) << "it is asked to, and says that it cannot";
}

TEST(SafetyFilter, ChangesTorquesNoFasterThanFromWhatTheDrivesAreTold) {
  SafetyFilterSettings settings = strict_settings();
  settings.max_torque_rate = 20e3;
  Kept kept(settings, false);
  kept.stand_at(Eigen::Vector3d(0.27, 0.0, 0.0), Eigen::Vector3d(1.5, 0.0, 0.0));
  const Eigen::Vector3d told(60.0, -60.0, 60.0);
  kept.ticking.set(kept.commanded,
                   TorqueCommand{.computed = kept.ticking.now(), .valid = true, .torque = told});
  kept.ask(Eigen::Vector3d::Zero());
  const JointVector next = kept.ask(Eigen::Vector3d::Zero()).torque;
  EXPECT_GT(next[0], 60.0 - 20.0 - 1e-9);
  EXPECT_LT(next[1], -60.0 + 20.0 + 1e-9);
}

TEST(SafetyFilter, HandsOnTheRequestWithoutAModel) {
  Kept kept(strict_settings());
  const Eigen::Vector3d torque(90.0, -90.0, 90.0);
  kept.stand_at(Eigen::Vector3d(5.0, 0.0, 0.0), Eigen::Vector3d::Zero());
  EXPECT_TRUE(equal(kept.ask(torque).torque, torque));
  EXPECT_TRUE(kept.ticking.get(kept.block.status).keeping);
  EXPECT_FALSE(kept.ticking.get(kept.block.status).valid);
}

TEST(SafetyFilter, NeverAllocates) {
  Kept kept(strict_settings());
  kept.stand_at(Eigen::Vector3d(0.28, 0.0, 0.0), Eigen::Vector3d(1.5, 0.0, 0.0));
  kept.ask(Eigen::Vector3d(90.0, -90.0, 90.0));
  const test::AllocationCounter counter;
  kept.ticking.tick();
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(kept.ticking.get(kept.block.status).steps, 0);
}

TEST(SafetyFilter, RefusesLimitsThatTheHomePoseExceeds) {
  SafetyFilterSettings settings = strict_settings();
  settings.limits.max_condition_number = 2.0;
  EXPECT_THROW(SafetyFilter(test::planar_rig(), settings), SetupError);
  settings = strict_settings();
  settings.braking.distance = 0.0;
  EXPECT_THROW(SafetyFilter(test::planar_rig(), settings), SetupError);
}

}  // namespace
}  // namespace flinch
