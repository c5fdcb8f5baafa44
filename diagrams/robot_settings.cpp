#include "diagrams/robot_settings.h"

#include <algorithm>

#include "diagrams/robot_constraints.h"
#include "systems/robot/joint_space_dynamics.h"

namespace flinch {
namespace {

constexpr double stopping_time = 29e-3;  // time constant of the controlled stop [s]
// D_qa and K_qa dt of [SafePR] (32e) over the inertia of a drive, which the paper does not print: 60 and 1
// Nms/rad at the rig [1/s].
constexpr double velocity_rate = 105.55;
constexpr double feedforward_rate = velocity_rate / 60.0;
// Natural frequencies of the nominal impedance [rad/s]. Encoders and currents are read too late for more;
// with less a platform hangs in its own weight.
constexpr double slowest_impedance = 10.0, fastest_impedance = 80.0;

/// A robot that rests at home.
struct AtHome {
  explicit AtHome(const ParallelRobot& robot) {
    robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), kinematics);
    robot.dynamics(kinematics, dynamics);
  }
  Kinematics kinematics;
  Dynamics dynamics;
};

/// The least inertia that a drive feels at the home pose while the others stand still [kg m^2 or kg]. Of more
/// drives than coordinates none can move alone: of the motion nearest to that.
double least_inertia(const AtHome& home) {
  return joint_space_dynamics(home.kinematics, home.dynamics).M_qa.diagonal().minCoeff();
}

/// That of [ICRA23] II-C, where the platform at home then swings no slower and no faster than above.
ImpedanceSettings impedance_for(const ParallelRobot& robot, const AtHome& home) {
  ImpedanceSettings settings = complete({}, robot.space());
  for (Eigen::Index i = 0; i < settings.stiffness.size(); ++i) {
    const double inertia = home.dynamics.M_x(i, i);
    settings.stiffness[i] = std::clamp(settings.stiffness[i], slowest_impedance * slowest_impedance * inertia,
                                       fastest_impedance * fastest_impedance * inertia);
  }
  return settings;
}

/// What the drives feel of friction at home while all of them move at `rate` [Nm or N].
JointVector friction_at(const ParallelRobot& robot, double rate) {
  Kinematics kinematics;
  Dynamics dynamics;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), kinematics);
  const PlatformVector velocity = kinematics.J_x_qa * JointVector::Constant(robot.drives(), rate);
  robot.kinematics(robot.home_pose(), velocity, kinematics);
  robot.dynamics(kinematics, dynamics);
  return joint_space_dynamics(kinematics, dynamics).tau_fr_qa;
}

/// Largest Coulomb friction of a drive: what is left of friction where its viscous part is taken out.
double coulomb_friction(const ParallelRobot& robot) {
  constexpr double slipping = 0.03;  // rate at which friction is no longer rounded [rad/s or m/s]
  return (2.0 * friction_at(robot, slipping) - friction_at(robot, 2.0 * slipping)).lpNorm<Eigen::Infinity>();
}

/// By how much the torque of a drive may change while its encoder stands still [Nm or N]: a drive that sticks
/// holds its Coulomb friction either way, and half of all friction is not known.
double unseen_torque(const ParallelRobot& robot, const DriveParameters& drives) {
  return std::max(0.06 * drives.max_torque, 4.0 * coulomb_friction(robot));
}

/// That tells a drive from one that friction holds, and turns round without a jump [Nm or N].
double checking_torque(const ParallelRobot& robot, const DriveParameters& drives) {
  const double moving = std::max(0.12 * drives.max_torque, 8.0 * coulomb_friction(robot));
  return std::min({moving, 0.3 * drives.max_torque, 0.45 * drives.max_torque_jump});
}

PlausibilityLimits plausibility_for(const DriveParameters& drives, double inertia) {
  PlausibilityLimits limits;
  limits.drive_acceleration = drives.max_torque / inertia;
  limits.torque_constant = drives.torque_constant;
  limits.current = 0.01 * drives.max_torque / drives.torque_constant.minCoeff();
  limits.still_torque = 0.1 * drives.max_torque;
  limits.resting_rate = drives.max_speed / 80.0;
  return limits;
}

/// Biases are learnt on the planar rig.
void forget_planar_biases(TouchHypothesesSettings& settings) {
  for (double* const bias :
       {&settings.platform_bias, &settings.link1_bias, &settings.link2_bias, &settings.clamping_bias})
    *bias = 0.0;
}

}  // namespace

void know_drives(const DriveParameters& drives, DriveTorqueSettings& settings) {
  settings.torque_constant = drives.torque_constant;
  settings.cogging = drives.cogging;
  settings.delay = drives.torque_delay;
}

void know_period(Time period, ContactControlSettings& settings) {
  const Sampling sampling = Sampling::each(period);
  settings.control_period = period;
  for (Sampling* const each :
       {&settings.velocity_filter.sampling, &settings.forward_kinematics.sampling,
        &settings.drive_torque.sampling, &settings.imu_ekf.sampling, &settings.extended_imu_ekf.sampling,
        &settings.unscented_imu_filter.sampling, &settings.momentum_observer.sampling,
        &settings.momentum_kalman_filter.inputs.sampling, &settings.sliding_mode_observer.inputs.sampling,
        &settings.disturbance_filter.sampling, &settings.imu_residual.sampling,
        &settings.fused_detector.tracking.sampling, &settings.limits_filter.sampling})
    *each = sampling;
  settings.sliding_mode_observer.substeps = periods_in(period, 100us);
  settings.imu_residual.rest_in_a_row = periods_in(50ms, period);
  settings.imu_residual.leaving_rest = periods_in(25ms, period);
  settings.imu_residual.rest_samples = periods_in(50ms, period);
  settings.contact_detector.period = period;
  settings.faults.longest_gap = sampling.longest_hold;
  settings.faults.max_age = longest_age(period);
  settings.plausibility.period = period;
  settings.drive_check.period = period;
}

ContactControlSettings settings_for(const ParallelRobot& robot, const DriveParameters& drives,
                                    const WorkspaceLimits& limits, Time period) {
  const AtHome home(robot);
  const double inertia = least_inertia(home);
  ContactControlSettings settings;
  know_drives(drives, settings.drive_torque);
  settings.impedance = impedance_for(robot, home);
  settings.sequence.rest_speed = drives.max_speed / 160.0;
  settings.faults.workspace = limits;
  settings.faults.max_joint_speed = drives.max_speed;
  settings.faults.rest_speed = settings.sequence.rest_speed;
  settings.faults.max_encoder_rate = drives.max_encoder_rate;
  settings.faults.max_control_error = drives.max_control_error;
  settings.faults.max_unseen_motion = drives.max_unseen_motion;
  settings.faults.max_torque_jump = drives.max_torque_jump * std::max(1.0, to_seconds(period) / 1e-3);
  settings.faults.torque_range = drives.max_torque;
  settings.faults.max_unseen_current = unseen_torque(robot, drives) / drives.torque_constant.minCoeff();
  settings.plausibility = plausibility_for(drives, inertia);
  settings.drive_check.torque = checking_torque(robot, drives);
  settings.torque_gate.max_torque = drives.max_torque;
  settings.torque_gate.max_torque_rate = drives.max_torque_rate;
  settings.fused_detector.tracking.resting_rate = settings.sequence.rest_speed;
  settings.controlled_stop.damping = inertia / stopping_time;
  settings.modes.max_torque_rate = drives.max_torque_rate;
  settings.limits.limits.workspace = limits;
  settings.limits.max_torque = drives.max_torque;
  settings.limits.max_torque_rate = drives.max_torque_rate;
  settings.tasks.constraints = constraints_for(robot, limits);
  settings.tasks.levels.velocity_gain = velocity_rate * inertia;
  settings.tasks.levels.velocity_feedforward = feedforward_rate * inertia;
  settings.tasks.levels.largest_torque = drives.max_torque;
  settings.tasks.levels.largest_torque_rate = drives.max_torque_rate;
  settings.tasks.reaction.rest_speed = settings.sequence.rest_speed;
  settings.tasks.reaction.max_torque = drives.max_torque;
  settings.tasks.reaction.max_torque_rate = drives.max_torque_rate;
  settings.limits.max_drive_speed = 0.95 * drives.max_speed;
  settings.yielding->damping = settings.controlled_stop.damping;
  settings.yielding->whole_from = drives.max_speed / 4.0;
  if (robot.space_dimension() == 3) forget_planar_biases(settings.isolation.hypotheses);
  know_period(period, settings);
  return settings;
}

}  // namespace flinch
