#include "experiments/scenario/scenario.h"

#include <algorithm>
#include <charconv>

#include "diagrams/robot_settings.h"
#include "experiments/scenario/calibration_warnings.h"
#include "experiments/scenario/key_values.h"
#include "experiments/scenario/robot_files.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "experiments/scenario/scenario_control.h"
#include "experiments/scenario/scenario_isolation.h"
#include "experiments/scenario/scenario_operator.h"
#include "experiments/scenario/scenario_pulls.h"
#include "experiments/verdict/body_regions.h"
#include "systems/config/config_file.h"
#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#include "systems/robot/body_id.h"

namespace flinch {
namespace {

/// What can be touched, by the names of the verdict.
std::vector<std::string> touchable(const ParallelRobot& robot) {
  std::vector<std::string> names = {"none"};
  for (int i = 0; i < robot.body_count(); ++i) names.push_back(body_name(BodyId::from_index(i)));
  for (int leg = 1; leg <= robot.legs(); ++leg) names.push_back("leg" + std::to_string(leg) + "_clamping");
  return names;
}

void read_expectations(ConfigReader expect, const ParallelRobot& robot, Expectations& expected) {
  if (expect.has("contact")) {
    std::string body;
    expect.text("contact", body);
    const std::vector<std::string> known = touchable(robot);
    if (std::find(known.begin(), known.end(), body) == known.end()) {
      expect.problem("contact",
                     "is '" + body + "', which is no body of this robot" + did_you_mean(body, known));
    }
    expected.contact = body;
  }
  expect.number("detection_time", unit::s, expected.detection_time, positive);
  expect.number("removal_time", unit::s, expected.removal_time, positive);
  expect.number("lasting_force", unit::N, expected.lasting_force, positive);
  expect.number("observer_error_force", unit::N, expected.observer_error, positive);
  expect.number("observer_error_moment", unit::Nm, expected.observer_error_moment, positive);
  expect.number("tracking_error", unit::m, expected.tracking_error, positive);
  expect.number("loop_closure", unit::m, expected.loop_closure, positive);
  expect.number("return_time", unit::s, expected.return_time, positive);
}

void read_force_limits(ConfigReader reader, ForceLimits& limits) {
  std::string region = limits.region;
  reader.text("region", region);
  if (const BodyRegion* const known = find_body_region(region)) {
    limits = force_limits_of(*known);
  } else {
    std::vector<std::string> names;
    for (const BodyRegion& each : body_regions()) names.emplace_back(each.name);
    reader.problem("region", "is '" + region + "', which is no region of the body that has limits" +
                                 did_you_mean(region, names));
  }
  const ForceLimits of_region = limits;
  reader.number("transient", unit::N, limits.transient, positive);
  reader.number("quasi_static", unit::N, limits.quasi_static, positive);
  const std::string by_hand = "set by the scenario";
  if (limits.transient != of_region.transient) limits.transient_source = by_hand;
  if (limits.quasi_static != of_region.quasi_static) limits.quasi_static_source = by_hand;
  reader.number("transient_duration", unit::s, limits.transient_duration, positive);
}

/// The robot of `scenario`. Where its file is no good the problems are noted and another robot of its kind
/// stands in, so that the rest of the scenario can be checked as well; a file that names no kind ends it.
RobotFile read_robot(ConfigReader& reader, RobotFiles& robots, Scenario& scenario) {
  std::optional<RobotFile> stand_in;
  try {
    reader.required().file("robot", scenario.robot_file);
    if (!scenario.robot_file.empty()) {
      const auto entry = robots.read(scenario.robot_file);
      scenario.robot_text = entry->text;
      scenario.calibrations = entry->calibrations;
      return entry->robot;
    }
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
    stand_in = preset_of_kind(scenario.robot_file);
  }
  if (stand_in) return *stand_in;
  reader.leave_rest_unread();
  reader.finish();
  throw SetupError(std::vector<std::string>{"there is no robot"});
}

/// Everything but the robot.
void read_rest(ConfigReader& reader, std::optional<std::uint64_t> seed, const SectionReader& others,
               Scenario& scenario) {
  const ParallelRobot& robot = *scenario.robot.robot;
  scenario.title = scenario.name;
  reader.text("title", scenario.title);
  reader.text("description", scenario.description);
  reader.required().duration("duration", scenario.duration, between(1e-3, 3600.0));
  reader.seed("seed", scenario.seed);
  if (seed) scenario.seed = *seed;
  ControlStages stages = std::move(scenario.control.stages);
  scenario.control_period = scenario.robot.control_period;
  read_control_period(reader, scenario.control_period);
  scenario.control =
      settings_for(robot, scenario.robot.drives, scenario.robot.limits, scenario.control_period);
  scenario.control.stages = std::move(stages);
  try {
    calibrate_control(scenario.calibrations, robot, scenario.control);
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
  }
  read_control(reader.section("control"), robot, scenario.control);
  find_networks(scenario.file.parent_path(), scenario.control.isolation);
  read_motion(reader.section("motion"), scenario.robot, scenario.seed, scenario.control);
  scenario.operator_script = read_operator(reader, robot, scenario.control, scenario.duration);
  scenario.obstacles = read_obstacles(reader);
  scenario.mountings = read_mountings(reader, robot);
  others(reader, scenario);
  read_expectations(reader.section("expect"), robot, scenario.expected);
  read_force_limits(reader.section("force_limits"), scenario.force_limits);
  scenario.values = reader.finish();
  scenario.warnings = warnings_about_calibrations(scenario);
}

Scenario assemble(ConfigReader reader, const std::filesystem::path& file, RobotFiles& robots,
                  std::optional<std::uint64_t> seed, const SectionReader& others,
                  const ControlStages& known) {
  require_kind(reader, FileKind::scenario);
  Scenario scenario;
  scenario.control.stages = known;
  scenario.file = file;
  scenario.name = file.stem().string();
  scenario.robot_as_built = read_robot(reader, robots, scenario);
  const auto read_once = [&robots](const std::filesystem::path& name) {
    return *robots.read_calibration(name);
  };
  for (ParameterFile& own : read_calibrations(reader, read_once))
    scenario.calibrations.push_back(std::move(own));
  scenario.robot = scenario.robot_as_built;
  try {
    if (reader.good()) scenario.robot = calibrated_robot(scenario);
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
  }
  read_rest(reader, seed, others, scenario);
  return scenario;
}

const std::string& attribute(const Recording& recording, const std::string& name,
                             const std::filesystem::path& file) {
  const auto found = recording.attributes.find(name);
  if (found == recording.attributes.end()) {
    throw SetupError(file.string() + ": the recording has no attribute '" + name +
                     "'; it was not made by 'flinch run'");
  }
  return found->second;
}

std::uint64_t recorded_seed(const Recording& recording, const std::filesystem::path& file) {
  const std::string& text = attribute(recording, "seed", file);
  std::uint64_t seed = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc{} && rest == end) return seed;
  throw SetupError(file.string() + ": the attribute 'seed' is '" + text +
                   "'; it must be a whole number between 0 and 2^64 - 1");
}

}  // namespace

void leave_simulation_unread(ConfigReader& file, const Scenario&) {
  for (const char* const section : {"plant", "applied_wrench", "sensors", "faults"})
    file.leave_unread(section);
  if (file.has("pylon")) file.section("pylon").leave_rest_unread();
  for (ConfigReader& obstacle : file.sections("obstacles")) obstacle.leave_rest_unread();
  for (ConfigReader& pull : file.sections("pulls")) pull.leave_rest_unread();
}

Scenario read_scenario(const std::filesystem::path& file, std::optional<std::uint64_t> seed,
                       const SectionReader& others, const ControlStages& known) {
  return parse_scenario(read_config_file(file), file, seed, others, known);
}

Scenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& set,
                       std::optional<std::uint64_t> seed, const SectionReader& others,
                       const ControlStages& known) {
  if (set.empty()) return read_scenario(file, seed, others, known);
  RobotFiles robots;
  const auto values_of = [&](const std::shared_ptr<const ConfigNode>& root) {
    return parse_scenario(root, file, robots, seed, others, known).values;
  };
  return parse_scenario(scenario_with(file, set, values_of), file, robots, seed, others, known);
}

Scenario parse_scenario(std::string text, const std::filesystem::path& file,
                        std::optional<std::uint64_t> seed, const SectionReader& others,
                        const ControlStages& known) {
  RobotFiles robots;
  Scenario scenario = assemble(ConfigReader::parse(text, file.string()), file, robots, seed, others, known);
  scenario.text = std::move(text);
  return scenario;
}

Scenario parse_scenario(const std::shared_ptr<const ConfigNode>& root, const std::filesystem::path& file,
                        RobotFiles& robots, std::optional<std::uint64_t> seed, const SectionReader& others,
                        const ControlStages& known) {
  Scenario scenario = assemble(ConfigReader::over(root, file.string()), file, robots, seed, others, known);
  scenario.text = yaml_text(*root);
  return scenario;
}

Scenario recorded_scenario(const Recording& recording, const std::filesystem::path& file,
                           const SectionReader& others, const ControlStages& known) {
  Scenario scenario;
  scenario.control.stages = known;
  scenario.file = attribute(recording, "scenario.file", file);
  scenario.name = attribute(recording, "scenario.name", file);
  scenario.text = attribute(recording, "scenario.text", file);
  scenario.robot_file = attribute(recording, "robot.file", file);
  scenario.robot_text = attribute(recording, "robot.text", file);
  ConfigReader reader = ConfigReader::parse(scenario.text, file.string() + ":" + scenario.file.string());
  std::string unused;
  reader.text("robot", unused);
  scenario.robot_as_built =
      parse_robot_file(scenario.robot_text, file.string() + ":" + scenario.robot_file.string());
  scenario.calibrations = recorded_calibrations(reader, recording, file);
  scenario.robot = calibrated_robot(scenario);
  read_rest(reader, recorded_seed(recording, file), others, scenario);
  return scenario;
}

}  // namespace flinch
