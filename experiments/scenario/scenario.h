#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "experiments/verdict/verdict.h"
#include "plant/simulated_station.h"
#include "systems/config/read_value.h"
#include "systems/config/robot_file.h"

namespace flinch {

struct Recording;

/// One experiment in simulation: what a scenario file says. apps/scenarios holds some, and explains the keys.
struct Scenario {
  std::filesystem::path file;
  std::string name;  ///< the file's name without ".yaml"
  std::string title;
  std::string description;
  std::uint64_t seed = 1;
  Time duration = 1s;

  std::filesystem::path robot_file;
  RobotFile robot;                   ///< what the controller believes
  SimulatedStationSettings station;  ///< what stands there really
  ContactControlSettings control;
  Expectations expected;
  ForceLimits force_limits;

  std::vector<ReadValue> values;  ///< every parameter of the scenario, defaults included
  std::string text;               ///< of the file
  std::string robot_text;         ///< of the robot file
};

/// Reads a scenario and the robot file it names; `seed` replaces the file's. Throws SetupError with all that
/// is wrong with both, a motion that the legs do not reach included.
Scenario read_scenario(const std::filesystem::path& file, std::optional<std::uint64_t> seed = std::nullopt);

/// The scenario that a recording was made from, out of the texts that it keeps. Throws SetupError naming
/// `file`, where the recording comes from, when it keeps none.
Scenario recorded_scenario(const Recording& recording, const std::filesystem::path& file);

}  // namespace flinch
