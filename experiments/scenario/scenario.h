#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/calibration_warnings.h"
#include "experiments/scenario/scenario_obstacles.h"
#include "experiments/verdict/verdict.h"
#include "systems/config/parameter_file.h"
#include "systems/config/read_value.h"
#include "systems/config/robot_file.h"
#include "systems/laws/scripted_operator.h"
#include "systems/signals/instrument_mounting.h"

namespace flinch {

class ConfigReader;
class RobotFiles;
struct ConfigNode;
struct Recording;

/// One experiment, whatever stands for the robot: what a scenario file says of it. docs/files.md has the
/// keys.
struct Scenario {
  std::filesystem::path file;
  std::string name;  ///< the file's name without ".yaml"
  std::string title;
  std::string description;
  std::uint64_t seed = 1;
  Time duration = 1s;
  Time control_period = default_control_period;  ///< that of the robot file where the scenario says nothing

  std::filesystem::path robot_file;
  RobotFile robot;           ///< what the controller believes
  RobotFile robot_as_built;  ///< what the robot file says, without calibrations
  std::vector<ParameterFile> calibrations;
  ContactControlSettings control;
  OperatorScript operator_script;
  std::vector<ScenarioObstacle> obstacles;
  std::vector<InstrumentMounting> mountings;  ///< of the instrument at which ropes pull
  Expectations expected;
  ForceLimits force_limits;

  /// What a run of it shows in which nothing was touched, though it should have been, in one sentence; empty:
  /// nobody knows more.
  std::function<std::string(const Scenario&, const Recording&)> near_miss;
  std::vector<CalibrationWarning> warnings;
  std::vector<ReadValue> values;  ///< every parameter of the scenario, defaults included
  std::string text;               ///< of the file
  std::string robot_text;         ///< of the robot file
};

/// Reads sections of a scenario file that a Scenario has no place for. `so_far` has robot, motion, control,
/// obstacles and seed; where the robot file is no good, a stand-in for the robot. Each call begins anew.
using SectionReader = std::function<void(ConfigReader& file, const Scenario& so_far)>;

/// The sections that only a simulation reads are left unread: whatever they say, nothing is wrong with them.
void leave_simulation_unread(ConfigReader& file, const Scenario& so_far);

/// Reads a scenario and the robot file it names; `seed` replaces the file's. Throws SetupError with all that
/// is wrong with both, a motion that the legs do not reach included. `known` are the stages that the file can
/// name; the first of a kind runs where it names none.
Scenario read_scenario(const std::filesystem::path& file, std::optional<std::uint64_t> seed = std::nullopt,
                       const SectionReader& others = leave_simulation_unread,
                       const ControlStages& known = known_stages());

/// The same with one value for each key of `set`, "KEY=VALUE" as scenario_with() takes them.
Scenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& set,
                       std::optional<std::uint64_t> seed = std::nullopt,
                       const SectionReader& others = leave_simulation_unread,
                       const ControlStages& known = known_stages());

/// The same for text that came from `file`.
Scenario parse_scenario(std::string text, const std::filesystem::path& file,
                        std::optional<std::uint64_t> seed = std::nullopt,
                        const SectionReader& others = leave_simulation_unread,
                        const ControlStages& known = known_stages());

/// The same for nodes that came from `file`, or were put in their place; its text is made from them.
/// `robots`: files that need not be read again.
Scenario parse_scenario(const std::shared_ptr<const ConfigNode>& root, const std::filesystem::path& file,
                        RobotFiles& robots, std::optional<std::uint64_t> seed = std::nullopt,
                        const SectionReader& others = leave_simulation_unread,
                        const ControlStages& known = known_stages());

/// The scenario that a recording was made from, out of the texts that it keeps. Throws SetupError naming
/// `file`, where the recording comes from, when it keeps none.
Scenario recorded_scenario(const Recording& recording, const std::filesystem::path& file,
                           const SectionReader& others = leave_simulation_unread,
                           const ControlStages& known = known_stages());

}  // namespace flinch
