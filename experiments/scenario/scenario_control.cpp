#include "experiments/scenario/scenario_control.h"

#include <cmath>
#include <optional>
#include <span>

#include "diagrams/contact_control_settings.h"
#include "diagrams/control_rate.h"
#include "diagrams/task_stages.h"
#include "experiments/scenario/scenario_estimators.h"
#include "experiments/scenario/scenario_isolation.h"
#include "experiments/scenario/scenario_pose.h"
#include "experiments/scenario/scenario_stages.h"
#include "experiments/scenario/scenario_tasks.h"
#include "experiments/scenario/scenario_thresholds.h"
#include "systems/config/config_reader.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/motion/random_path.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {
namespace {

std::span<double> entries(PlatformVector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

void read_limits(ConfigReader reader, PoseLimits& limits) {
  reader.number("velocity", unit::m_per_s, limits.translation.velocity, positive);
  reader.number("acceleration", unit::m_per_s2, limits.translation.acceleration, positive);
  reader.number("jerk", unit::m_per_s3, limits.translation.jerk, positive);
  reader.number("angular_velocity", unit::rad_per_s, limits.rotation.velocity, positive);
  reader.number("angular_acceleration", unit::rad_per_s2, limits.rotation.acceleration, positive);
  reader.number("angular_jerk", unit::rad_per_s3, limits.rotation.jerk, positive);
}

void read_sensing(ConfigReader& control, const ParallelRobot& robot, ContactControlSettings& settings) {
  ConfigReader filter = control.section("velocity_filter");
  filter.number("cutoff_frequency", unit::Hz, settings.velocity_filter.low_pass.cutoff_frequency, positive);
  filter.choice("form", settings.velocity_filter.low_pass.form,
                {{"tustin", LowPassForm::tustin}, {"backward_difference", LowPassForm::backward_difference}});

  ConfigReader pose = control.section("forward_kinematics");
  if (pose.has("initial_pose"))
    settings.forward_kinematics.initial_pose = read_pose_in_reach(pose, "initial_pose", robot);

  ConfigReader drives = control.section("drive_torque");
  const bool turn = robot.drive_kind(0) == DriveKind::revolute;
  drives.numbers(turn ? "torque_constant" : "force_constant", turn ? unit::Nm_per_A : unit::N_per_A,
                 entries(settings.drive_torque.torque_constant), positive);
  drives.flag("aligned_with_velocity", settings.aligned_with_velocity);
  control.flag("drive_check", settings.checks_drives);
}

void read_laws(ConfigReader& control, const ParallelRobot& robot, ContactControlSettings& settings) {
  control.section("plausibility")
      .number("imu_deviations", unit::none, settings.plausibility.inertial, positive);
  ConfigReader impedance = control.section("impedance");
  const std::span<double> stiffness = entries(settings.impedance.stiffness);
  const auto translations = static_cast<std::size_t>(robot.space().translations());
  const std::span<double> rotational = stiffness.subspan(translations);
  impedance.numbers("translational_stiffness", unit::N_per_m, stiffness.first(translations), not_negative);
  if (rotational.size() == 1) {
    impedance.number("rotational_stiffness", unit::Nm_per_rad, rotational.front(), not_negative);
  } else if (!rotational.empty()) {
    impedance.numbers("rotational_stiffness", unit::Nm_per_rad, rotational, not_negative);
  }
  impedance.numbers("damping_ratio", unit::none, entries(settings.impedance.damping_ratio), positive);
  impedance.flag("compensate_friction", settings.impedance.compensate_friction);

  ConfigReader retraction = control.section("retraction");
  retraction.number("distance", unit::m, settings.retraction.distance, positive);
  retraction.number("angle", unit::rad, settings.retraction.angle, positive);
  retraction.number("stiffness_share", unit::none, settings.reaction_stiffness, fraction);
  read_limits(retraction.section("limits"), settings.retraction.limits);

  const bool is_strict = followed_name(settings.stages.reaction_laws) == "strict_reaction";
  if (is_strict) keep_constraints_strictly(robot, settings);
  ConfigReader limits = control.section("limits");
  using Use = SafetyFilterSettings::Use;
  limits.choice("keep", settings.limits.use,
                {{"never", Use::never}, {"after_contact", Use::after_contact}, {"always", Use::always}});
  if (is_strict && settings.limits.use == Use::never) {
    limits.problem("keep",
                   "is 'never', but strict_reaction leaves all limits to this; keep them 'always' or "
                   "'after_contact', or follow torque_reaction, whose tasks lead to them");
  }
  limits.number("max_condition_number", unit::none, settings.limits.limits.max_condition_number, positive);
  limits.number("min_self_collision_distance", unit::m,
                settings.limits.limits.workspace.min_self_collision_distance, not_negative);
  limits.number("max_platform_speed", unit::m_per_s, settings.limits.max_platform_speed, positive);
  const char* const whose =
      is_strict ? ", and strict_reaction keeps no less than constraints.self_collision.safety_m" : "";
  for (const std::string& problem : problems(settings.limits.limits.workspace, robot))
    limits.problem("", problem + whose);

  ConfigReader sequence = control.section("sequence");
  sequence.flag("zero_g_when_struck", settings.sequence.zero_g_when_struck);
  bool damped = settings.yielding.has_value();
  sequence.flag("zero_g_damped", damped);
  if (!damped) settings.yielding.reset();
}

/// What a robot may do that is brought back inside its limits.
void read_recovery(ConfigReader reader, ContactControlSettings& settings) {
  reader.number("speed_share", unit::none, settings.faults.recovery_speed, fraction);
  reader.number("torque_share", unit::none, settings.torque_gate.recovery_torque, fraction);
  reader.number("margin_share", unit::none, settings.faults.recovery_margin, fraction);
  reader.duration("over_after", settings.torque_gate.recovered_after, not_negative);
  read_limits(reader.section("limits"), settings.trajectory.recovery);
}

/// In a plane the angle `direction` from the x axis; in space a vector of any length.
CartesianVector read_direction(ConfigReader& motion, const ParallelRobot& robot) {
  if (robot.space_dimension() == 2) {
    double angle = 0.0;
    motion.required().number("direction", unit::rad, angle);
    return Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  CartesianVector direction = CartesianVector::Zero(robot.space_dimension());
  motion.required().numbers("direction", unit::none,
                            {direction.data(), static_cast<std::size_t>(direction.size())});
  return direction;
}

std::optional<PlatformPath> read_through(ConfigReader& motion, const ParallelRobot& robot) {
  std::vector<Configuration> poses;
  for (ConfigReader& pose : motion.sections("poses")) poses.push_back(read_pose(pose, robot));
  PoseLimits limits{.translation = {.velocity = 1.0, .acceleration = 12.0, .jerk = 600.0},
                    .rotation = {.velocity = 4.0, .acceleration = 80.0, .jerk = 8000.0}};
  read_limits(motion.section("limits"), limits);
  if (!motion.good()) return std::nullopt;
  return PlatformPath::through(robot, poses, limits);
}

std::optional<PlatformPath> read_passage(ConfigReader& motion, const ParallelRobot& robot) {
  PassageSettings settings;
  settings.pose = read_pose(motion.section("pose"), robot);
  settings.direction = read_direction(motion, robot);
  motion.required().number("speed", unit::m_per_s, settings.speed, positive);
  motion.number("cruise", unit::m, settings.cruise, positive);
  motion.number("acceleration", unit::m_per_s2, settings.acceleration, positive);
  motion.number("jerk", unit::m_per_s3, settings.jerk, positive);
  if (!motion.good()) return std::nullopt;
  return passage(robot, settings).path;
}

std::optional<PlatformPath> read_square(ConfigReader& motion, const ParallelRobot& robot) {
  double side = 0.3;
  int laps = 1;
  PoseLimits limits{.translation = {.velocity = 1.5, .acceleration = 12.0, .jerk = 600.0},
                    .rotation = {.velocity = 4.0, .acceleration = 80.0, .jerk = 8000.0}};
  const Configuration centre = read_pose(motion.section("centre"), robot);
  motion.number("side", unit::m, side, positive);
  motion.integer("laps", laps, 1, 1000);
  read_limits(motion.section("limits"), limits);
  if (!motion.good()) return std::nullopt;
  return PlatformPath::square(robot, centre, side, limits, laps);
}

std::optional<PlatformPath> read_random(ConfigReader& motion, const RobotFile& file, std::uint64_t seed) {
  const ParallelRobot& robot = *file.robot;
  RandomPathSettings settings;
  settings.centre = motion.has("centre") ? read_pose(motion.section("centre"), robot) : robot.home_pose();
  motion.number("distance", unit::m, settings.distance, positive);
  motion.number("rotation", unit::rad, settings.rotation, not_negative);
  motion.number("duration", unit::s, settings.duration, between(1e-3, 3600.0));
  motion.number("pause", unit::s, settings.pause, between(0.0, 3600.0));
  read_limits(motion.section("limits"), settings.limits);
  settings.workspace = file.limits;
  settings.max_drive_speed = file.drives.max_speed;
  if (!motion.good()) return std::nullopt;
  return random_path(robot, settings, seed);
}

enum class MotionKind { hold, through, passage, square, random };

}  // namespace

void read_control(ConfigReader control, const ParallelRobot& robot, ContactControlSettings& settings) {
  settings.impedance = complete(settings.impedance, robot.space());  // so that a file can change one entry
  const std::vector<std::string> estimators = names_of(settings.stages.estimators);
  read_stages(control, settings.stages);
  read_sensing(control, robot, settings);
  read_estimators(control, robot, settings);
  read_thresholds(control, robot.drive_kind(0), &robot.space(), estimators, settings);
  read_isolation(control.section("isolation"), {robot.drive_kind(0), static_cast<std::size_t>(robot.legs())},
                 settings.isolation);
  read_tasks(control, robot, settings.tasks);
  read_laws(control, robot, settings);
  read_recovery(control.section("recovery"), settings);
  for (const TooFast& filter : too_fast_for_rate(settings))
    control.section(filter.section).problem(filter.key, filter.complaint);
}

void read_motion(ConfigReader motion, const RobotFile& file, std::uint64_t seed,
                 ContactControlSettings& settings) {
  const ParallelRobot& robot = *file.robot;
  MotionKind kind = MotionKind::hold;
  Time start = Time::zero();
  const bool is_known = motion.choice("kind", kind,
                                      {{"hold", MotionKind::hold},
                                       {"through", MotionKind::through},
                                       {"passage", MotionKind::passage},
                                       {"square", MotionKind::square},
                                       {"random", MotionKind::random}});
  if (!is_known) return motion.leave_rest_unread();
  motion.duration("start", start, not_negative);
  settings.trajectory.start = start;
  try {
    if (kind == MotionKind::through) settings.trajectory.path = read_through(motion, robot);
    if (kind == MotionKind::passage) settings.trajectory.path = read_passage(motion, robot);
    if (kind == MotionKind::square) settings.trajectory.path = read_square(motion, robot);
    if (kind == MotionKind::random) settings.trajectory.path = read_random(motion, file, seed);
  } catch (const SetupError& error) {
    for (const std::string& problem : error.problems())
      motion.problem("", "the robot cannot move like this: " + problem);
  }
}

}  // namespace flinch
