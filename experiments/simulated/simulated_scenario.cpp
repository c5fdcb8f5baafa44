#include "experiments/simulated/simulated_scenario.h"

#include "experiments/simulated/scenario_station.h"

namespace flinch {
namespace {

SectionReader station_into(SimulatedStationSettings& station, Specimen& specimen) {
  return
      [&](ConfigReader& file, const Scenario& scenario) { read_station(file, scenario, station, specimen); };
}

}  // namespace

SimulatedScenario read_simulated_scenario(const std::filesystem::path& file,
                                          std::optional<std::uint64_t> seed, const ControlStages& known) {
  SimulatedStationSettings station;
  Specimen specimen;
  Scenario scenario = read_scenario(file, seed, station_into(station, specimen), known);
  return {std::move(scenario), std::move(station), std::move(specimen)};
}

SimulatedScenario read_simulated_scenario(const std::filesystem::path& file,
                                          const std::vector<std::string>& set,
                                          std::optional<std::uint64_t> seed, const ControlStages& known) {
  SimulatedStationSettings station;
  Specimen specimen;
  Scenario scenario = read_scenario(file, set, seed, station_into(station, specimen), known);
  return {std::move(scenario), std::move(station), std::move(specimen)};
}

SimulatedScenario parse_simulated_scenario(std::string text, const std::filesystem::path& file,
                                           std::optional<std::uint64_t> seed, const ControlStages& known) {
  SimulatedStationSettings station;
  Specimen specimen;
  Scenario scenario = parse_scenario(std::move(text), file, seed, station_into(station, specimen), known);
  return {std::move(scenario), std::move(station), std::move(specimen)};
}

SimulatedScenario parse_simulated_scenario(const std::shared_ptr<const ConfigNode>& root,
                                           const std::filesystem::path& file, RobotFiles& robots,
                                           std::optional<std::uint64_t> seed, const ControlStages& known) {
  SimulatedStationSettings station;
  Specimen specimen;
  Scenario scenario = parse_scenario(root, file, robots, seed, station_into(station, specimen), known);
  return {std::move(scenario), std::move(station), std::move(specimen)};
}

SimulatedScenario recorded_simulated_scenario(const Recording& recording, const std::filesystem::path& file,
                                              const ControlStages& known) {
  SimulatedStationSettings station;
  Specimen specimen;
  Scenario scenario = recorded_scenario(recording, file, station_into(station, specimen), known);
  return {std::move(scenario), std::move(station), std::move(specimen)};
}

}  // namespace flinch
