#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "plant/perturbed_robot.h"
#include "plant/simulated_station.h"

namespace flinch {

/// A scenario with what stands behind its control path in simulation.
struct SimulatedScenario : Scenario {
  SimulatedStationSettings station;
  /// The robot of `station`, where it is one of many that differ from their model.
  PerturbedRobot perturbed_robot;
};

/// As read_scenario(), parse_scenario() and recorded_scenario(), with the sections that describe the
/// simulation.
SimulatedScenario read_simulated_scenario(const std::filesystem::path& file,
                                          std::optional<std::uint64_t> seed = std::nullopt,
                                          const ControlStages& known = known_stages());
SimulatedScenario read_simulated_scenario(const std::filesystem::path& file,
                                          const std::vector<std::string>& set,
                                          std::optional<std::uint64_t> seed = std::nullopt,
                                          const ControlStages& known = known_stages());
SimulatedScenario parse_simulated_scenario(std::string text, const std::filesystem::path& file,
                                           std::optional<std::uint64_t> seed = std::nullopt,
                                           const ControlStages& known = known_stages());
SimulatedScenario parse_simulated_scenario(const std::shared_ptr<const ConfigNode>& root,
                                           const std::filesystem::path& file, RobotFiles& robots,
                                           std::optional<std::uint64_t> seed = std::nullopt,
                                           const ControlStages& known = known_stages());
SimulatedScenario recorded_simulated_scenario(const Recording& recording, const std::filesystem::path& file,
                                              const ControlStages& known = known_stages());

}  // namespace flinch
