#include "systems/safety/fault_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>

#include "systems/foundation/findings.h"

namespace flinch {
namespace {

template <class Vector>
bool fits(const Vector& vector, int size) {
  return vector.size() == size && vector.allFinite();
}

bool fits_drives(const JointVector& vector, const ParallelRobot& robot) {
  return fits(vector, robot.drives());
}

double largest(const auto& vector) {
  return vector.size() == 0 ? 0.0 : vector.template lpNorm<Eigen::Infinity>();
}

bool is_old(Time time, const Evidence& e) { return std::chrono::abs(e.now - time) > e.limits.max_age; }

// ---------------------------------------------------------------- station and sensors

bool loop_late(const Evidence& e) { return e.timing.valid && e.timing.lateness > e.limits.max_lateness; }

bool station_silent(const Evidence& e) {
  return e.station_gap > e.limits.longest_gap || (e.station.valid && is_old(e.station.acquired, e));
}

bool station_fault(const Evidence& e) { return e.station.valid && e.station.fault; }

bool station_disabled(const Evidence& e) { return e.station.valid && !e.station.enabled; }

bool joints_invalid(const Evidence& e) { return e.joints_gap > e.limits.longest_gap; }

bool joints_stale(const Evidence& e) { return e.joints.valid && is_old(e.joints.acquired, e); }

/// Whether those who look for contradictions have found this.
bool contradicted(const Evidence& e, GateFault fault) {
  return e.plausibility.valid && (e.plausibility.present & fault_bit(fault)) != 0;
}

bool encoder_jump(const Evidence& e) {
  if (contradicted(e, GateFault::encoder_jump)) return true;
  const double interval = std::max(to_seconds(e.encoders.interval), 1e-3);
  return largest(e.encoders.step) > e.limits.max_encoder_rate * interval;
}

bool encoder_frozen(const Evidence& e) {
  if (contradicted(e, GateFault::encoder_frozen)) return true;
  if (e.encoders.step.size() == 0) return false;  // no reading, which is another fault
  for (Eigen::Index i = 0; i < e.encoders.angle.size(); ++i) {
    if (e.encoders.repeated(i) <= e.limits.longest_repetition) continue;
    if (e.encoders.unseen_motion(i) > e.limits.max_unseen_motion) return true;
    if (e.encoders.unseen_current(i) > e.limits.max_unseen_current) return true;
  }
  return false;
}

bool velocity_invalid(const Evidence& e) { return !e.has_motion; }

bool drives_invalid(const Evidence& e) { return e.drives_gap > e.limits.longest_gap; }

bool drives_stale(const Evidence& e) { return e.drives.valid && is_old(e.drives.acquired, e); }

// ---------------------------------------------------------------- where the robot is

bool forward_kinematics(const Evidence& e) {
  using Status = PlatformMotion::Status;
  const Status status = e.platform.status;
  return status == Status::no_data || status == Status::not_converged || (e.platform.valid() && !e.has_pose);
}

bool encoders_implausible(const Evidence& e) {
  return e.platform.status == PlatformMotion::Status::implausible ||
         contradicted(e, GateFault::encoders_implausible);
}

bool type_1_singularity(const Evidence& e) {
  return e.has_pose && !(e.measures.valid && std::abs(e.measures.det_B) >= e.limits.workspace.min_abs_det_B);
}

/// Or beyond it, in another assembly mode than home.
bool type_2_singularity(const Evidence& e) {
  if (e.platform.status == PlatformMotion::Status::singular) return true;
  const double least = e.limits.workspace.min_abs_det_A;
  const double room = least > 0.0 ? e.measures.det_A : std::abs(e.measures.det_A);
  return e.has_pose && !(e.measures.valid && room >= least);
}

bool workspace_radius(const Evidence& e) {
  return e.has_pose &&
         distance_from_centre(e.limits.workspace, e.robot, e.platform.pose) > e.limits.workspace.max_distance;
}

bool orientation(const Evidence& e) {
  return e.has_pose && e.robot.space().rotation_angle(e.platform.pose) > e.limits.workspace.max_rotation;
}

bool joint_range(const Evidence& e) {
  return e.has_motion && (e.motion.position.minCoeff() < e.limits.workspace.min_active ||
                          e.motion.position.maxCoeff() > e.limits.workspace.max_active);
}

bool recovers(const Evidence& e) { return e.reaction.mode == ReactionMode::recover; }

bool joint_speed(const Evidence& e) {
  const bool degraded = e.plausibility.valid && e.plausibility.passive_lost;
  const double share = recovers(e) ? e.limits.recovery_speed : (degraded ? e.limits.degraded_speed : 1.0);
  return e.has_motion && largest(e.motion.velocity) > share * e.limits.max_joint_speed;
}

bool self_collision(const Evidence& e) {
  const WorkspaceLimits& limits = e.limits.workspace;
  return e.has_pose && !(e.measures.valid && e.measures.sigma_sc >= limits.min_self_collision_distance &&
                         e.measures.platform_gap >= limits.min_platform_gap);
}

// ---------------------------------------------------------------- observers and laws

bool contact_unmonitored(const Evidence& e) {
  return !e.detection.valid || (e.plausibility.valid && e.plausibility.learning);
}

/// A reference that the legs do not reach cannot be followed.
bool control_error(const Evidence& e) {
  if (!e.reference.valid || !e.has_motion) return false;
  if (!e.robot.space().contains(e.reference.pose)) return true;
  const InverseSolution wanted = e.robot.inverse_kinematics(e.reference.pose, e.robot.home_working_mode());
  if (!wanted.reachable) return true;
  const JointVector error = e.robot.drive_difference(wanted.joints.active, e.motion.position);
  return largest(error) > e.limits.max_control_error;
}

bool command_invalid(const Evidence& e) { return !e.command.valid; }

bool command_stale(const Evidence& e) { return e.command.valid && is_old(e.command.computed, e); }

bool command_not_finite(const Evidence& e) { return e.command.valid && !e.has_command; }

/// Torques that are not let through have changed from those of one mode to those of none.
bool torque_jump(const Evidence& e) {
  if (e.reaction.mode == ReactionMode::stopped) return false;
  if (!e.has_command || !e.last_command.valid || !fits_drives(e.last_command.torque, e.robot)) return false;
  const double range = e.limits.torque_range;
  const auto within = [range](const JointVector& torque) { return torque.cwiseMin(range).cwiseMax(-range); };
  return largest((within(e.command.torque) - within(e.last_command.torque)).eval()) >
         e.limits.max_torque_jump;
}

bool operator_stop(const Evidence& e) { return e.buttons.stop; }

bool touched_in_recovery(const Evidence& e) {
  return recovers(e) && e.detection.valid && e.detection.present_level != ContactLevel::none;
}

/// In motion or, before the first one, when they were checked.
bool torque_contradicted(const Evidence& e) {
  return contradicted(e, GateFault::torque_contradicted) ||
         e.drive_check.phase == DriveCheckStatus::Phase::failed;
}

// ---------------------------------------------------------------- the table

template <GateFault fault>
bool found_contradicted(const Evidence& e) {
  return contradicted(e, fault);
}

constexpr std::array rows{
    FaultRow{GateFault::loop_late, Doubt::time, 0, loop_late, "the control loop is late"},
    FaultRow{GateFault::station_silent, Doubt::drives, 3, station_silent,
             "the station does not say how it is"},
    FaultRow{GateFault::station_fault, Doubt::drives, 0, station_fault, "the station reports a fault"},
    FaultRow{GateFault::station_disabled, Doubt::drives, 0, station_disabled,
             "the station does not act on torques"},
    FaultRow{GateFault::joints_invalid, Doubt::angles, 2, joints_invalid, "no usable angles of the drives"},
    FaultRow{GateFault::joints_stale, Doubt::angles, 3, joints_stale, "the angles of the drives are too old"},
    FaultRow{GateFault::encoder_jump, Doubt::angles, 0, encoder_jump, "the angle of a drive jumps"},
    FaultRow{GateFault::encoder_frozen, Doubt::angles, 6, encoder_frozen,
             "the angle of a drive does not follow it"},
    FaultRow{GateFault::velocity_invalid, Doubt::rates, 0, velocity_invalid, "no rates of the drives"},
    FaultRow{GateFault::drives_invalid, Doubt::currents, 2, drives_invalid, "no usable motor currents"},
    FaultRow{GateFault::drives_stale, Doubt::currents, 3, drives_stale, "the motor currents are too old"},
    FaultRow{GateFault::forward_kinematics, Doubt::angles, 0, forward_kinematics,
             "the platform's pose is not known"},
    FaultRow{GateFault::encoders_implausible, Doubt::angles, 0, encoders_implausible,
             "encoders contradict each other or the last pose"},
    FaultRow{GateFault::type_1_singularity, Doubt::nothing, 0, type_1_singularity,
             "a leg is nearly stretched or folded"},
    FaultRow{GateFault::type_2_singularity, Doubt::nothing, 0, type_2_singularity,
             "the drives nearly lose hold of the platform"},
    FaultRow{GateFault::workspace_radius, Doubt::nothing, 0, workspace_radius, "the platform is too far out"},
    FaultRow{GateFault::orientation, Doubt::nothing, 0, orientation, "the platform is turned too far"},
    FaultRow{GateFault::joint_range, Doubt::nothing, 0, joint_range, "a drive is outside its range"},
    FaultRow{GateFault::joint_speed, Doubt::nothing, 0, joint_speed, "a drive is too fast"},
    FaultRow{GateFault::self_collision, Doubt::nothing, 0, self_collision,
             "links are too close to one another or to the platform"},
    FaultRow{GateFault::contact_unmonitored, Doubt::nothing, 0, contact_unmonitored,
             "contacts would not be detected"},
    FaultRow{GateFault::control_error, Doubt::nothing, 0, control_error,
             "a drive is too far from its reference"},
    FaultRow{GateFault::command_invalid, Doubt::laws, 0, command_invalid, "the laws have no torques"},
    FaultRow{GateFault::command_stale, Doubt::laws, 3, command_stale, "the laws' torques are too old"},
    FaultRow{GateFault::command_not_finite, Doubt::laws, 0, command_not_finite,
             "the laws' torques are no numbers"},
    FaultRow{GateFault::torque_jump, Doubt::laws, 0, torque_jump, "the laws' torques jump"},
    FaultRow{GateFault::operator_stop, Doubt::nothing, 0, operator_stop, "the operator stops the robot"},
    FaultRow{GateFault::touched_in_recovery, Doubt::nothing, 0, touched_in_recovery,
             "the robot is touched while it recovers"},
    FaultRow{GateFault::motion_contradicted, Doubt::angles, 0,
             found_contradicted<GateFault::motion_contradicted>, "encoders and IMU tell different motions"},
    FaultRow{GateFault::drive_not_following, Doubt::drives, 0,
             found_contradicted<GateFault::drive_not_following>,
             "a motor's current is not that of its command"},
    FaultRow{GateFault::drives_without_effect, Doubt::drives, 0,
             found_contradicted<GateFault::drives_without_effect>, "torques change and nothing moves"},
    FaultRow{GateFault::stop_ineffective, Doubt::drives, 0, found_contradicted<GateFault::stop_ineffective>,
             "a controlled stop does not slow the robot down, or does not end"},
    FaultRow{GateFault::brake_not_holding, Doubt::drives, 0, found_contradicted<GateFault::brake_not_holding>,
             "a drive moves that its brake should hold"},
    FaultRow{GateFault::status_contradicted, Doubt::drives, 0,
             found_contradicted<GateFault::status_contradicted>,
             "the station says that the brakes are closed, which should be open"},
    FaultRow{GateFault::torque_contradicted, Doubt::drives, 0, torque_contradicted,
             "a drive's torque has the wrong sign or is missing"},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (static_cast<std::size_t>(rows[i].fault) != i + 1) return false;
  }
  return true;
}
static_assert(in_order(), "the table has one row for each fault, in their order");

}  // namespace

std::vector<std::string> problems(const FaultLimits& limits, const ParallelRobot& robot) {
  Findings found;
  found.add_all(problems(limits.workspace, robot));
  found.require(limits.max_lateness >= Time::zero(), "max_lateness must not be negative");
  found.require(limits.max_encoder_rate > limits.max_joint_speed,
                "max_encoder_rate must exceed max_joint_speed");
  found.require(limits.longest_repetition >= Time::zero(), "longest_repetition must not be negative");
  found.require(limits.max_unseen_motion > 0, "max_unseen_motion must be positive");
  found.require(limits.max_unseen_current > 0, "max_unseen_current must be positive");
  found.require(limits.longest_gap >= Time::zero(), "longest_gap must not be negative");
  found.require(limits.max_age >= Time::zero(), "max_age must not be negative");
  found.require(limits.max_joint_speed > 0, "max_joint_speed must be positive");
  found.require(limits.rest_speed > 0, "rest_speed must be positive");
  found.require(limits.max_control_error > 0, "max_control_error must be positive");
  found.require(limits.max_torque_jump > 0, "max_torque_jump must be positive");
  found.require(limits.torque_range > 0, "torque_range must be positive");
  found.require(limits.recovery_speed > 0 && limits.recovery_speed <= 1,
                "recovery_speed must be above 0 and at most 1");
  found.require(limits.degraded_speed > 0 && limits.degraded_speed <= 1,
                "degraded_speed must be above 0 and at most 1");
  found.require(limits.recovery_margin >= 0, "recovery_margin must not be negative");
  return found.take();
}

std::span<const FaultRow> fault_table() noexcept { return rows; }

bool is_usable(const JointReading& joints, const ParallelRobot& robot) noexcept {
  return joints.valid && fits_drives(joints.active, robot);
}

bool is_usable(const DriveReading& drives, const ParallelRobot& robot) noexcept {
  return drives.valid && fits_drives(drives.current, robot);
}

bool is_usable(const JointMotion& motion, const ParallelRobot& robot) noexcept {
  return motion.valid && fits_drives(motion.position, robot) && fits_drives(motion.velocity, robot);
}

bool is_usable(const PlatformMotion& platform, const ParallelRobot& robot) noexcept {
  return platform.valid() && robot.space().contains(platform.pose) && fits(platform.velocity, robot.dof());
}

bool is_usable(const TorqueCommand& command, const ParallelRobot& robot) noexcept {
  return command.valid && fits_drives(command.torque, robot);
}

FaultMask faults_that_doubt(Doubt doubt) noexcept {
  FaultMask doubting = 0;
  for (const FaultRow& row : rows) {
    if (row.doubt == doubt) doubting |= fault_bit(row.fault);
  }
  return doubting;
}

FaultMask find_faults(const Evidence& evidence) noexcept {
  FaultMask found = 0;
  for (const FaultRow& row : rows) {
    if (row.present(evidence)) found |= fault_bit(row.fault);
  }
  return found;
}

GateFault first_fault(FaultMask faults) noexcept {
  return faults == 0 ? GateFault::none : static_cast<GateFault>(std::countr_zero(faults));
}

GateReaction worst_reaction(FaultMask faults) noexcept {
  GateReaction worst = GateReaction::none;
  for (const FaultRow& row : rows) {
    if ((faults & fault_bit(row.fault)) != 0) worst = std::max(worst, row.reaction());
  }
  return worst;
}

}  // namespace flinch
