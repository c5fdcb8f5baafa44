#include "experiments/robot_check/robot_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "diagrams/robot_constraints.h"
#include "experiments/robot_check/robot_workspace.h"
#include "systems/robot/alike_links.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array tried_conditions = {5.0, 10.0, 15.0, 20.0};
constexpr double degrees = 180.0 / std::numbers::pi;

/// What a robot does at rest at home.
struct AtHome {
  Kinematics kinematics;
  JointVector efforts;  ///< That hold it [Nm or N].

  explicit AtHome(const ParallelRobot& robot) {
    robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), kinematics);
    Dynamics dynamics;
    robot.dynamics(kinematics, dynamics);
    efforts = drive_torques(kinematics, dynamics.g_x);
  }
};

/// How drives are told: turning ones in degrees and Nm, sliding ones in mm and N.
struct DriveWords {
  bool turns;
  double scale() const { return turns ? degrees : 1e3; }
  const char* position() const { return turns ? "deg" : "mm"; }
  const char* effort() const { return turns ? "Nm" : "N"; }
};

DriveWords words_of(const ParallelRobot& robot) { return {robot.drive_kind(0) == DriveKind::revolute}; }

template <class Vector>
std::string joined(const Vector& values, double scale, const char* format) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(format), scale * value + 0.0);
  return text;
}

double percent(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

std::size_t count_above(const std::vector<double>& ascending, double value) {
  return static_cast<std::size_t>(ascending.end() -
                                  std::upper_bound(ascending.begin(), ascending.end(), value));
}
std::size_t count_below(const std::vector<double>& ascending, double value) {
  return static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), value) -
                                  ascending.begin());
}
double at_share(const std::vector<double>& ascending, double share) {
  return ascending[static_cast<std::size_t>(share * static_cast<double>(ascending.size() - 1) + 0.5)];
}

/// "legs 1, 2 and 3"
std::string alike_legs(const ParallelRobot& robot) {
  const std::vector<bool> alike = legs_of_alike_links(robot);
  if (std::all_of(alike.begin(), alike.end(), [](bool one) { return one; })) return "each leg";
  std::string legs;
  for (std::size_t leg = 0; leg < alike.size(); ++leg) {
    if (alike[leg]) legs += (legs.empty() ? "leg " : ", leg ") + std::to_string(leg + 1);
  }
  return legs;
}

constexpr std::size_t first_column = 18, columns = 79;

/// A line of the summary, wrapped between words.
std::string line(const char* name, const std::string& what) {
  std::string text, row = fmt::format("  {:<{}}", name, first_column - 2);
  for (std::size_t at = 0; at < what.size();) {
    const std::size_t end = std::min(what.find(' ', at), what.size());
    if (row.size() > first_column && row.size() + 1 + end - at > columns) {
      text += row + "\n";
      row = std::string(first_column, ' ');
    }
    row += (row.size() > first_column ? " " : "") + what.substr(at, end - at);
    at = end + 1;
  }
  return text + row + "\n";
}

std::string robot_line(const RobotFile& file) {
  const ParallelRobot& robot = *file.robot;
  const int translations = robot.space().translations();
  const int rotations = robot.space().rotations();
  std::string moves = translations == 2 ? "x, y" : "x, y, z";
  moves += rotations == 0 ? "" : rotations == 1 ? ", and turns in the plane" : ", and turns";
  const bool redundant = robot.drives() > robot.dof();
  return line(
      "robot",
      fmt::format("{}: {} legs; {} drives that {}{}, {} passive joints measured; moves in {}; "
                  "controlled every {:g} ms",
                  robot.name(), robot.legs(), robot.drives(), words_of(robot).turns ? "turn" : "slide",
                  redundant ? ", more than it needs" : "", robot.passive_joints(), moves,
                  1e-6 * static_cast<double>(file.control_period.count())));
}

std::string home_line(const RobotFile& file, const AtHome& home) {
  const ParallelRobot& robot = *file.robot;
  const DriveWords drives = words_of(robot);
  return line("home",
              fmt::format("({}) mm; condition number {:.2f}; drives at {} {}; held there by {} {} of {:.4g}",
                          joined(robot.home_pose().head(robot.space().translations()), 1e3, "{:.0f}"),
                          home.kinematics.sigma_kappa,
                          joined(home.kinematics.joints.active, drives.scale(), "{:.1f}"), drives.position(),
                          joined(home.efforts, 1.0, "{:.3g}"), drives.effort(), file.drives.max_torque));
}

std::string reach_line(const RobotWorkspace& workspace) {
  static constexpr std::array names = {"x", "y", "z"};
  std::string text;
  for (std::size_t axis = 0; axis < workspace.reach.size(); ++axis) {
    text += fmt::format("{}{} {:.0f} to {:.0f}", axis == 0 ? "" : ", ", names[axis],
                        1e3 * workspace.reach[axis][0], 1e3 * workspace.reach[axis][1]);
  }
  return line("reach", text + " mm, turned as at home");
}

std::string limits_line(const RobotFile& file, const RobotWorkspace& workspace) {
  const std::vector<std::string> names = limit_names(*file.robot);
  std::string text =
      fmt::format("{:.0f} % of the poses in reach", percent(workspace.within(), workspace.poses));
  std::string beyond;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (workspace.breaking[i] == 0) continue;
    beyond += fmt::format("{}{} {:.0f} %", beyond.empty() ? "; beyond " : ", ", names[i],
                          percent(workspace.breaking[i], workspace.poses));
  }
  text += beyond;
  if (workspace.beyond_singularity > 0) {
    text += fmt::format("; behind a singularity {:.0f} %",
                        percent(workspace.beyond_singularity, workspace.poses));
  }
  return line("within limits", text);
}

std::string condition_lines(const RobotFile& file, const RobotWorkspace& workspace) {
  const std::vector<double>& kappa = workspace.sigma_kappa;
  if (kappa.empty()) return "";
  std::string above;
  for (const double value : tried_conditions) {
    above += fmt::format("{}{:.0f} in {:.0f} %", above.empty() ? "" : ", ", value,
                         percent(count_above(kappa, value), kappa.size()));
  }
  const ConstraintSettings constraints = constraints_for(*file.robot, file.limits);
  return line("condition",
              fmt::format("{:.2f} in half of them, {:.2f} in nine tenths, {:.3g} at most; above {}",
                          at_share(kappa, 0.5), at_share(kappa, 0.9), kappa.back(), above)) +
         line("reactions keep",
              fmt::format(
                  "by default a condition number of {:.3g} ({:.0f} % of them are beyond), links {:.0f} "
                  "mm apart ({:.0f} %)",
                  constraints.sigma_kappa.safety,
                  percent(count_above(kappa, constraints.sigma_kappa.safety), kappa.size()),
                  1e3 * constraints.sigma_sc.safety,
                  percent(count_below(workspace.self_collision_distance, constraints.sigma_sc.safety),
                          kappa.size())));
}

std::string singularity_line(const RobotWorkspace& workspace) {
  if (!workspace.nearest_singularity)
    return line("singularities", "none on straight ways from home before they are out of reach");
  return line("singularities",
              fmt::format("the nearest on straight ways from home after {:.0f} mm, towards ({})",
                          1e3 * workspace.nearest_singularity->distance,
                          joined(workspace.nearest_singularity->direction, 1.0, "{:.2g}")));
}

std::string defaults_line(const RobotFile& file) {
  std::string text;
  for (const ReadValue& value : file.values) {
    if (value.from_file || value.key.starts_with("legs[")) continue;
    text += (text.empty() ? "" : "; ") + value.key + " " + value.value +
            (value.unit.empty() ? "" : " " + value.unit);
  }
  return text.empty() ? text : line("by default", text);
}

}  // namespace

std::string robot_summary_text(const RobotFile& file) {
  const ParallelRobot& robot = *file.robot;
  const AtHome home(robot);
  const RobotWorkspace workspace = robot_workspace(robot, file.limits);
  const DriveWords drives = words_of(robot);
  std::string text =
      robot_line(file) + home_line(file, home) + reach_line(workspace) + limits_line(file, workspace);
  if (workspace.within() > 0) {
    text += condition_lines(file, workspace) +
            line("drives there", fmt::format("{:.0f} to {:.0f} {}", drives.scale() * workspace.drives[0],
                                             drives.scale() * workspace.drives[1], drives.position()));
  }
  text += singularity_line(workspace);
  if (const std::string legs = alike_legs(robot); !legs.empty()) {
    text += line("not told apart",
                 "a touch of the one and of the other link of " + legs + ", which load the robot alike");
  }
  return text + defaults_line(file);
}

Json robot_summary_json(const RobotFile& file) {
  const ParallelRobot& robot = *file.robot;
  const AtHome home(robot);
  const RobotWorkspace workspace = robot_workspace(robot, file.limits);
  const auto list = [](const auto& values) { return std::vector<double>(values.begin(), values.end()); };
  Json summary = {{"name", robot.name()},
                  {"legs", robot.legs()},
                  {"drives", robot.drives()},
                  {"dof", robot.dof()},
                  {"passive_joints", robot.passive_joints()},
                  {"home_condition_number", home.kinematics.sigma_kappa},
                  {"home_drives", list(home.kinematics.joints.active)},
                  {"home_efforts", list(home.efforts)},
                  {"reach_m", workspace.reach},
                  {"poses", workspace.poses},
                  {"poses_within_limits", workspace.within()},
                  {"poses_behind_singularity", workspace.beyond_singularity}};
  const std::vector<std::string> names = limit_names(robot);
  for (std::size_t i = 0; i < names.size(); ++i) summary["poses_beyond"][names[i]] = workspace.breaking[i];
  for (const double value : tried_conditions) {
    summary["condition_number_above"][fmt::format("{:.0f}", value)] =
        workspace.within() == 0
            ? 0.0
            : 0.01 * percent(count_above(workspace.sigma_kappa, value), workspace.within());
  }
  summary["drive_range"] = workspace.within() > 0 ? Json(workspace.drives) : Json(nullptr);
  summary["nearest_singularity_m"] =
      workspace.nearest_singularity ? Json(workspace.nearest_singularity->distance) : Json(nullptr);
  summary["defaults"] = Json::array();
  for (const ReadValue& value : file.values) {
    if (!value.from_file)
      summary["defaults"].push_back({{"key", value.key}, {"value", value.value}, {"unit", value.unit}});
  }
  return summary;
}

}  // namespace flinch
