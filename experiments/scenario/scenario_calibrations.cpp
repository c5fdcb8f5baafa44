#include "experiments/scenario/scenario_calibrations.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "diagrams/robot_settings.h"
#include "experiments/scenario/largest_stamp_spread.h"
#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_isolation.h"
#include "experiments/scenario/scenario_thresholds.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool changes_robot(const ParameterFile& file) {
  return std::any_of(file.parameters.begin(), file.parameters.end(), [](const FileParameter& parameter) {
    return parameter.belongs_to == "robot" && parameter.identifiable;
  });
}

bool has_thresholds(const ParameterFile& file) {
  return file.nodes != nullptr && ConfigReader::over(file.nodes, file.file).has("control");
}

/// Throws SetupError with all that is wrong with the section `control` of the file.
/// `robot`: null: not known.
void take_thresholds(const ParameterFile& file, DriveKind drives, const ParallelRobot* robot,
                     ContactControlSettings& control) {
  ConfigReader reader = ConfigReader::over(file.nodes, file.file);
  ConfigReader section = reader.section("control");
  ConfigReader isolation = section.section("isolation");
  KnownDrives known{drives, {}};
  if (robot != nullptr) known.count = static_cast<std::size_t>(robot->legs());
  read_thresholds(section, drives, robot == nullptr ? nullptr : &robot->space(),
                  names_of(control.stages.estimators), control);
  read_wrench_errors(isolation, known, control.isolation);
  reader.leave_rest_unread();
  reader.finish();
}

/// Sets the entry of the vector that `name` means, such as "control.imu_mount.position_m[2]".
void set_entry(const FileParameter& parameter, const std::string& vector, Eigen::Vector3d& values) {
  for (int i = 0; i < 3; ++i) {
    if (parameter.name == vector + "[" + std::to_string(i) + "]") values[i] = parameter.value;
  }
}

Time stamp_spread(const ParameterFile& file, const FileParameter& parameter,
                  std::vector<std::string>& problems) {
  if (parameter.value >= 0.0 && parameter.value <= to_seconds(largest_stamp_spread))
    return from_seconds(parameter.value);
  problems.push_back(fmt::format("{}: {}: is {:g} s, and must be 0 to {:g} s", file.file, parameter.name,
                                 parameter.value, to_seconds(largest_stamp_spread)));
  return {};
}

}  // namespace

std::vector<ParameterFile> recorded_calibrations(ConfigReader& scenario, const Recording& recording,
                                                 const std::filesystem::path& file) {
  std::string unused;
  for (ConfigReader& entry : scenario.sections("calibrations")) entry.text("file", unused);
  std::vector<ParameterFile> files;
  for (int number = 1;; ++number) {
    const std::string name = "calibration." + std::to_string(number);
    const auto found = recording.attributes.find(name + ".text");
    if (found == recording.attributes.end()) return files;
    files.push_back(parse_parameter_file(found->second, file.string() + ":" + found->first));
    const auto called = recording.attributes.find(name + ".file");
    if (called != recording.attributes.end()) files.back().file = called->second;
  }
}

RobotFile calibrated_robot(const Scenario& scenario) {
  if (std::none_of(scenario.calibrations.begin(), scenario.calibrations.end(), changes_robot))
    return scenario.robot_as_built;
  const std::string robot = scenario.robot_file.string();
  std::string text = scenario.robot_text;
  for (const ParameterFile& file : scenario.calibrations) {
    text = out_of(file.file + ": does not fit " + robot, [&] { return with_parameters(text, robot, file); });
  }
  return parse_robot_file(text, robot + ", calibrated");
}

void calibrate_control(const std::vector<ParameterFile>& calibrations, const ParallelRobot& robot,
                       ContactControlSettings& control) {
  std::vector<std::string> problems;
  for (const ParameterFile& file : calibrations) {
    try {
      if (has_thresholds(file)) take_thresholds(file, robot.drive_kind(0), &robot, control);
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
    for (const FileParameter& parameter : file.parameters) {
      if (parameter.belongs_to != "scenario" || !parameter.identifiable) continue;
      set_entry(parameter, "control.imu_mount.position_m", control.imu_mount.position_in_platform);
      set_entry(parameter, "control.imu_mount.angles_rad", control.imu_mount.angles);
      if (parameter.name == "control.imu_stamps.spread")
        control.imu_stamp_spread = stamp_spread(file, parameter, problems);
    }
  }
  throw_if_any(std::move(problems));
}

void check_thresholds(const std::vector<ParameterFile>& files, const RobotFile& robot) {
  ContactControlSettings control = settings_for(*robot.robot, robot.drives, robot.limits);
  control.stages = known_stages();
  calibrate_control(files, *robot.robot, control);
}

void check_thresholds(const ParameterFile& file) {
  if (!has_thresholds(file)) return;
  std::vector<std::string> fewest;
  for (const DriveKind drives : {DriveKind::revolute, DriveKind::prismatic}) {
    ContactControlSettings control;
    control.stages = known_stages();
    control.contact_detector.hard = {infinity, infinity};  // what it leaves out, another file may say
    try {
      return take_thresholds(file, drives, nullptr, control);
    } catch (const SetupError& error) {
      if (fewest.empty() || error.problems().size() < fewest.size()) fewest = error.problems();
    }
  }
  throw SetupError(fewest);
}

}  // namespace flinch
