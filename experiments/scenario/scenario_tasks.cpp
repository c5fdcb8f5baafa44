#include "experiments/scenario/scenario_tasks.h"

#include "diagrams/task_settings.h"
#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// The gains of one task, the same for each of its rows. `force`: unit of the stiffness of the torque level.
void read_gains(ConfigReader reader, const Unit& force, TaskGains& gains) {
  reader.number("velocity", unit::per_s, gains.velocity[0], positive);
  reader.number("stiffness", unit::per_s2, gains.stiffness[0], positive);
  reader.number("damping", unit::per_s, gains.damping[0], positive);
  reader.number("force", force, gains.force[0], positive);
  reader.number("damping_ratio", unit::none, gains.damping_ratio[0], positive);
}

void read_levels(ConfigReader reader, bool turn, TaskLevelSettings& levels) {
  const Unit& damping = turn ? unit::Nms_per_rad : unit::Ns_per_m;
  reader.choice("priorities", levels.priorities,
                {{"recursive", PriorityForm::recursive},
                 {"augmented", PriorityForm::augmented},
                 {"printed", PriorityForm::printed}});
  reader.number("free_damping", unit::per_s, levels.free_damping, positive);
  reader.number("velocity_gain", damping, levels.velocity_gain, positive);
  reader.number("velocity_feedforward", damping, levels.velocity_feedforward, not_negative);
  reader.number("largest_acceleration", turn ? unit::rad_per_s2 : unit::m_per_s2, levels.largest_acceleration,
                positive);
  reader.number("largest_torque", turn ? unit::Nm : unit::N, levels.largest_torque, positive);
  reader.number("largest_torque_rate", turn ? unit::Nm_per_s : unit::N_per_s, levels.largest_torque_rate,
                positive);
}

void read_motion_limits(ConfigReader reader, MotionLimits& limits, bool angular) {
  reader.number("velocity", angular ? unit::rad_per_s : unit::m_per_s, limits.velocity, positive);
  reader.number("acceleration", angular ? unit::rad_per_s2 : unit::m_per_s2, limits.acceleration, positive);
  reader.number("jerk", angular ? unit::rad_per_s3 : unit::m_per_s3, limits.jerk, positive);
}

void read_reaction(ConfigReader reader, ReactionTaskSettings& reaction) {
  reader.number("displacement", unit::m, reaction.displacement, positive);
  reader.number("first_link_angle", unit::rad, reaction.first_link_angle, positive);
  reader.number("opening_angle", unit::rad, reaction.opening_angle, positive);
  reader.number("opening_step", unit::rad, reaction.opening_step, positive);
  reader.number("largest_opening", unit::rad, reaction.largest_opening, positive);
  reader.flag("opening_by_priority", reaction.opening_by_priority);
  reader.flag("along_force_only", reaction.along_force_only);
  reader.number("force_to_go_by", unit::N, reaction.force_to_go_by, positive);
  reader.flag("retreat", reaction.retreat);
  reader.duration("decide_within", reaction.decide_within, not_negative);
  reader.number("released_force", unit::N, reaction.released_force, positive);
  reader.number("released_moment", unit::Nm, reaction.released_moment, positive);
  reader.duration("pressed_for", reaction.pressed_for, not_negative);
  reader.number("inertial_share", unit::none, reaction.inertial_share, not_negative);
  reader.duration("released_for", reaction.released_for, not_negative);
  reader.number("largest_platform_speed", unit::m_per_s, reaction.largest_platform_speed, positive);
  read_motion_limits(reader.section("translation"), reaction.translation, false);
  read_motion_limits(reader.section("joint"), reaction.joint, true);
  read_gains(reader.section("platform"), unit::N_per_m, reaction.platform);
  read_gains(reader.section("first_link"), unit::Nm_per_rad, reaction.first_link);
  read_gains(reader.section("second_link"), unit::N_per_m, reaction.second_link);
  read_gains(reader.section("opening"), unit::Nm_per_rad, reaction.opening);
}

void read_constraints(ConfigReader reader, ConstraintSettings& constraints) {
  reader.choice("kept", constraints.kept,
                {{"never", ConstraintsKept::never},
                 {"after_contact", ConstraintsKept::after_contact},
                 {"always", ConstraintsKept::always}});
  reader.duration("dwell", constraints.dwell, not_negative);
  ConfigReader kappa = reader.section("condition_number");
  kappa.number("activation", unit::none, constraints.sigma_kappa.activation, positive);
  kappa.number("safety", unit::none, constraints.sigma_kappa.safety, positive);
  read_gains(kappa.section("gains"), unit::Nm, constraints.sigma_kappa.gains);
  ConfigReader distance = reader.section("self_collision");
  distance.number("activation", unit::m, constraints.sigma_sc.activation, positive);
  distance.number("safety", unit::m, constraints.sigma_sc.safety, positive);
  read_gains(distance.section("gains"), unit::N_per_m, constraints.sigma_sc.gains);
}

}  // namespace

void read_tasks(ConfigReader& control, const ParallelRobot& robot, TaskSettings& settings) {
  ConfigReader tasks = control.section("tasks");
  tasks.duration("blend", settings.blend, not_negative);
  read_levels(tasks.section("levels"), robot.drive_kind(0) == DriveKind::revolute, settings.levels);
  ConfigReader nominal = tasks.section("nominal");
  read_gains(nominal.section("position"), unit::N_per_m, settings.nominal.position);
  if (robot.space().rotations() > 0) {
    read_gains(nominal.section("orientation"), unit::Nm_per_rad, settings.nominal.orientation);
  }
  read_reaction(tasks.section("reaction"), settings.reaction);
  ConfigReader constraints = control.section("constraints");
  read_constraints(constraints, settings.constraints);
  if (!constraints.good()) return;
  for (const std::string& problem : problems(settings.constraints)) constraints.problem("", problem);
}

}  // namespace flinch
