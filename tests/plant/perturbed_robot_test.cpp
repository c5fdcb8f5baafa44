#include "plant/perturbed_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

std::vector<std::shared_ptr<const ParallelRobot>> robots() {
  return {test::individual_rig(RigFriction::test_rig),
          std::make_shared<const FiveBar>(five_bar_robot(FiveBarElbows::outward, FiveBarFriction::bearings)),
          std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::none, HexapodFriction::ball_screws))};
}

PerturbedRobot draw(const ParallelRobot& robot, std::uint64_t seed) {
  return draw_perturbed_robot(rig_realism(robot.drive_kind(0)), robot, 100.0, seed);
}

/// Lowest and highest of many draws.
struct Spread {
  double low = 1e300;
  double high = -1e300;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const JointVector& values) {
    for (const double value : values) add(value);
  }
};

/// The draws fill the interval, and nothing lies outside.
void expect_to_fill(const Spread& found, double low, double high) {
  const double edge = 0.02 * (high - low);
  EXPECT_GE(found.low, low);
  EXPECT_LE(found.low, low + edge);
  EXPECT_LE(found.high, high);
  EXPECT_GE(found.high, high - edge);
}

TEST(PerturbedRobot, FillsTheSizesThatItIsDrawnFrom) {
  for (const auto& robot : robots()) {
    const Realism sizes = rig_realism(robot->drive_kind(0));
    Spread friction, elbows, legs, platform, payload, constant, cogging, fourth, ripple, lag, encoder, phase,
        offset;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      const PerturbedRobot one = draw(*robot, seed);
      friction.add(one.mechanics.drive_friction_scale);
      elbows.add(one.mechanics.passive_friction_scale);
      legs.add(one.mechanics.leg_inertia_scale);
      platform.add(one.mechanics.platform_inertia_scale);
      payload.add(one.mechanics.payload);
      constant.add(one.torque_constant_scale);
      lag.add(one.current_lag);
      offset.add(one.passive_encoder_offset);
      for (const TorqueRipple& torque : one.torque_ripple) {
        ASSERT_EQ(torque.cogging.size(), 4U);
        cogging.add(torque.cogging[0].amplitude);
        fourth.add(torque.cogging[3].amplitude);
        EXPECT_DOUBLE_EQ(torque.cogging[3].rate, 4.0 * torque.cogging[0].rate);
        ripple.add(torque.ripple.amplitude);
      }
      for (const PositionHarmonic& wave : one.active_encoder_wave) {
        encoder.add(wave.amplitude);
        phase.add(wave.phase);
      }
    }
    expect_to_fill(friction, 0.8, 1.2);
    expect_to_fill(elbows, 0.8, 1.2);
    expect_to_fill(legs, 0.97, 1.03);
    expect_to_fill(platform, 0.97, 1.03);
    expect_to_fill(payload, 0.0, 0.1);
    expect_to_fill(constant, 0.985, 1.015);
    expect_to_fill(cogging, 0.0, 0.5);
    expect_to_fill(fourth, 0.0, 0.125);
    expect_to_fill(ripple, 0.0, 0.01);
    expect_to_fill(lag, 0.0, 0.3e-3);
    expect_to_fill(encoder, 0.0, sizes.active_encoder_wave);
    expect_to_fill(phase, 0.0, 2.0 * std::numbers::pi);
    if (robot->passive_joints() > 0)
      expect_to_fill(offset, -sizes.passive_encoder_offset, sizes.passive_encoder_offset);
  }
}

TEST(PerturbedRobot, IsTheSameForTheSameSeedAndAnotherForAnother) {
  for (const auto& robot : robots()) {
    EXPECT_EQ(perturbed_robot_values(draw(*robot, 7), *robot),
              perturbed_robot_values(draw(*robot, 7), *robot));
    const auto one = perturbed_robot_values(draw(*robot, 7), *robot);
    const auto other = perturbed_robot_values(draw(*robot, 8), *robot);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].first, other[i].first);
      for (std::size_t k = 0; k < one[i].second.size(); ++k) {
        EXPECT_NE(one[i].second[k], other[i].second[k]) << one[i].first;
      }
    }
  }
}

TEST(PerturbedRobot, HasOneQuantityAloneJustAsWithAllOthers) {
  const auto robot = robots()[0];
  const PerturbedRobot all = draw(*robot, 3);
  const PerturbedRobot alone = draw_perturbed_robot({.friction = 0.2, .cogging = 0.005}, *robot, 100.0, 3);
  EXPECT_EQ(alone.mechanics.drive_friction_scale, all.mechanics.drive_friction_scale);
  EXPECT_EQ(alone.torque_ripple[1].cogging[0].amplitude, all.torque_ripple[1].cogging[0].amplitude);
  EXPECT_EQ(alone.torque_ripple[1].cogging[0].phase, all.torque_ripple[1].cogging[0].phase);
  EXPECT_EQ(alone.torque_ripple[1].ripple.amplitude, 0.0);
  std::vector<std::string> told;
  for (const auto& [key, values] : perturbed_robot_values(alone, *robot)) told.push_back(key);
  EXPECT_EQ(told, std::vector<std::string>(
                      {"drive_friction_scale", "passive_friction_scale", "cogging_Nm", "cogging_phase_rad"}));
}

TEST(PerturbedRobot, WithoutAnySizeIsTheModel) {
  for (const auto& robot : robots()) {
    const PerturbedRobot none = draw_perturbed_robot(Realism(), *robot, 100.0, 5);
    EXPECT_TRUE(perturbed_robot_values(none, *robot).empty());
    SimulatedStationSettings model;
    model.rig.robot = robot;
    const SimulatedStationSettings station = with_perturbed_robot(model, none);
    EXPECT_TRUE(station.rig.torque_ripple.empty());
    EXPECT_EQ(station.drives.torque_constant.size(), 0);
    EXPECT_EQ(station.encoders.passive.accuracy, model.encoders.passive.accuracy);
    Kinematics k;
    Dynamics model_dynamics, dynamics;
    const PlatformVector velocity = PlatformVector::Constant(robot->dof(), 0.3);
    robot->kinematics(robot->home_pose(), velocity, k);
    robot->dynamics(k, model_dynamics);
    station.rig.robot->dynamics(k, dynamics);
    EXPECT_EQ(dynamics.M_x, model_dynamics.M_x);
    EXPECT_EQ(dynamics.F_fr_x, model_dynamics.F_fr_x);
  }
}

TEST(PerturbedRobot, IsHeavierOrLighterAndRubsMoreOrLessInEveryMechanism) {
  for (const auto& robot : robots()) {
    SimulatedStationSettings model;
    model.rig.robot = robot;
    const PerturbedRobot drawn = draw(*robot, 11);
    const SimulatedStationSettings station = with_perturbed_robot(model, drawn);
    const int n = robot->dof();
    Kinematics k;
    Dynamics believed, truth;
    robot->kinematics(robot->home_pose(), PlatformVector::Constant(n, 0.3), k);
    robot->dynamics(k, believed);
    station.rig.robot->dynamics(k, truth);
    // The payload adds its mass to each translation; the rest changes by 3 % at most.
    const int directions = robot->space_dimension();
    Eigen::MatrixXd rest = truth.M_x;
    rest.diagonal().head(directions).array() -= drawn.mechanics.payload;
    const double changed = (rest - Eigen::MatrixXd(believed.M_x)).norm() / believed.M_x.norm();
    EXPECT_GT(changed, 1e-4) << robot->name();
    EXPECT_LT(changed, 0.03) << robot->name();
    const double friction = (truth.F_fr_x - believed.F_fr_x).norm() / believed.F_fr_x.norm();
    EXPECT_GT(friction, 1e-3) << robot->name();
    EXPECT_LT(friction, 0.6) << robot->name();
  }
}

TEST(PerturbedRobot, HasElasticDrivesWhereTheirStiffnessIsGiven) {
  for (const auto& robot : robots()) {
    Spread stiffness, backlash;
    const Realism sizes{.drive_stiffness = 5e4, .backlash = 1e-3, .rotor_inertia = 0.02};
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      const PerturbedRobot one = draw_perturbed_robot(sizes, *robot, 100.0, seed);
      stiffness.add(one.elastic.stiffness);
      backlash.add(one.elastic.backlash);
      EXPECT_EQ(one.elastic.rotor_inertia, JointVector::Constant(robot->drives(), 0.02));
    }
    expect_to_fill(stiffness, 5e4, 1e5);
    expect_to_fill(backlash, 0.0, 1e-3);
    SimulatedStationSettings model;
    model.rig.robot = robot;
    const PerturbedRobot one = draw_perturbed_robot(sizes, *robot, 100.0, 3);
    EXPECT_EQ(with_perturbed_robot(model, one).rig.elastic.stiffness, one.elastic.stiffness);
  }
}

TEST(PerturbedRobot, LeavesWhatTheDriverBelieves) {
  SimulatedStationSettings model;
  model.rig.robot = robots()[0];
  PerturbedRobot perturbed_robot;
  perturbed_robot.torque_constant_scale = Eigen::Vector3d(1.01, 0.99, 1.0);
  const SimulatedDrivesSettings drives = with_perturbed_robot(model, perturbed_robot).drives;
  EXPECT_TRUE(drives.torque_constant.isApprox(6.1 * Eigen::Vector3d(1.01, 0.99, 1.0)));
  EXPECT_EQ(drives.driver_torque_constant, JointVector::Constant(3, 6.1));
}

TEST(PerturbedRobot, PutsAnOffsetInThePlaceOfTheEncodersAccuracy) {
  SimulatedStationSettings model;
  model.rig.robot = robots()[0];
  PerturbedRobot perturbed_robot;
  perturbed_robot.passive_encoder_offset = Eigen::Vector3d(1e-3, 0.0, -1e-3);
  const EncoderErrors passive = with_perturbed_robot(model, perturbed_robot).encoders.passive;
  EXPECT_EQ(passive.accuracy, 0.0);
  EXPECT_EQ(passive.offset, perturbed_robot.passive_encoder_offset);
}

}  // namespace
}  // namespace flinch
