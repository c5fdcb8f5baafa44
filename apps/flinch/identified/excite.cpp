// flinch excite: a motion from which the dynamics of a robot can be told.
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/flinch/command_line.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "experiments/scenario/scenario.h"
#include "identification/excitation.h"
#include "systems/config/config_node.h"
#include "systems/config/robot_file.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

std::string list(const auto& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.5f}", text.empty() ? "" : ", ", value);
  return "[" + text + "]";
}

std::string pose_line(const Configuration& pose, const ConfigurationSpace& space) {
  static constexpr const char* axes[] = {"x_m", "y_m", "z_m"};
  std::string text;
  for (int i = 0; i < space.translations(); ++i)
    text += fmt::format("{}{}: {:.5f}", text.empty() ? "" : ", ", axes[i], pose[i]);
  if (space.rotations() == 1) text += fmt::format(", phi_rad: {:.5f}", pose[space.translations()]);
  if (space.rotations() == 3) {
    const Eigen::Vector4d q = pose.tail<4>();
    text += ", rotation_rad: " + list(quaternion_log(q));
  }
  return "    - {" + text + "}\n";
}

std::string scenario_text(const Excitation& motion, const ExcitationSettings& settings,
                          const ParallelRobot& robot, const std::string& robot_file,
                          const ExciteOptions& options) {
  const PoseLimits& limits = settings.path.limits;
  std::string text =
      "# A motion from which `flinch calibrate dynamics` tells friction and inertia. Designed by\n#   " +
      comment_text(options.common.command_line) + "\n";
  text += fmt::format(
      "# Condition number of the regressor {:.4g}, of the random motion before {:.4g}; rank {} of {}.\n",
      motion.condition, motion.first_condition, motion.rank, motion.parameters);
  text += "title: Motion that excites the dynamics\n";
  text += fmt::format("description: Between {} poses, from rest to rest; nothing touches the robot.\n",
                      motion.poses.size());
  text += "robot: " + yaml_line(*scalar_node(robot_file)) + "\n";
  text += fmt::format("duration_s: {:.1f}\nseed: 1\n\n", motion.duration + 1.2);
  text += "motion:\n  kind: through\n  start_ms: 500\n  poses:\n";
  for (const Configuration& pose : motion.poses) text += pose_line(pose, robot.space());
  text += fmt::format(
      "  limits: {{velocity_m_per_s: {:g}, acceleration_m_per_s2: {:g}, jerk_m_per_s3: {:g}, "
      "angular_velocity_rad_per_s: {:g}, angular_acceleration_rad_per_s2: {:g}, angular_jerk_rad_per_s3: "
      "{:g}}}\n\n",
      limits.translation.velocity, limits.translation.acceleration, limits.translation.jerk,
      limits.rotation.velocity, limits.rotation.acceleration, limits.rotation.jerk);
  text +=
      "control:\n  contact_detector: {reaction_force_N: 1000, reaction_moment_Nm: 100, hard_force_N: 1000, "
      "hard_moment_Nm: 100}\n\nexpect: {contact: none}\n";
  return text;
}

}  // namespace

ExitStatus excite(const ExciteOptions& options) {
  require_output(options.out, {options.robot}, OutputKind::scenario);
  const RobotFile file = read_robot_file(options.robot);
  ExcitationSettings settings;
  settings.path.duration = options.duration;
  settings.path.distance = options.distance;
  settings.path.rotation = options.rotation_deg * std::numbers::pi / 180.0;
  settings.path.limits.translation = {.velocity = options.velocity,
                                      .acceleration = options.acceleration,
                                      .jerk = 50.0 * options.acceleration};
  settings.path.limits.rotation = {.velocity = 4.0, .acceleration = 40.0, .jerk = 2000.0};
  settings.path.workspace = file.limits;
  settings.path.max_drive_speed = file.drives.max_speed;
  settings.max_torque = file.drives.max_torque;
  settings.trials = options.trials;
  Excitation motion;
  {
    Progress progress("designing", options.common.quiet || options.common.json);
    motion = out_of(options.robot, [&] {
      return design_excitation(*file.robot, settings, options.seed,
                               [&](double share) { progress.show(share); });
    });
  }
  const std::filesystem::path folder = std::filesystem::absolute(options.out).parent_path();
  const std::string robot =
      std::filesystem::relative(std::filesystem::absolute(options.robot), folder).string();
  const std::string text = scenario_text(motion, settings, *file.robot, robot, options);
  out_of("the scenario is not written, for it could not be run",
         [&] { return parse_scenario(text, options.out); });
  write_result(options.out, text);
  if (options.common.json) {
    print_result("{}\n", json_text(nlohmann::ordered_json{{"scenario", options.out.string()},
                                                          {"poses", motion.poses.size()},
                                                          {"duration_s", motion.duration},
                                                          {"condition", motion.condition},
                                                          {"first_condition", motion.first_condition},
                                                          {"rank", motion.rank},
                                                          {"parameters", motion.parameters},
                                                          {"peak_torque", motion.peak_torque}}));
  } else {
    print_result("condition {:.4g}, of the random motion before {:.4g}; rank {} of {} parameters\n",
                 motion.condition, motion.first_condition, motion.rank, motion.parameters);
    const bool turn = file.robot->drive_kind(0) == DriveKind::revolute;
    print_result("{} poses, {:.1f} s, drive {} up to {:.0f} of {:.0f} {}\nscenario: {}\n",
                 motion.poses.size(), motion.duration, turn ? "torques" : "forces", motion.peak_torque,
                 file.drives.max_torque, turn ? "Nm" : "N", options.out.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
