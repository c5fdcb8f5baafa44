#include "experiments/simulated/simulated_scenario.h"

#include <utility>

#include "experiments/simulated/near_miss.h"
#include "experiments/simulated/scenario_station.h"

namespace flinch {
namespace {

/// A scenario that `read` reads, handing the sections of the simulation on.
template <class Read>
SimulatedScenario with_station(const Read& read) {
  SimulatedStationSettings station;
  PerturbedRobot perturbed_robot;
  Scenario scenario = read([&](ConfigReader& file, const Scenario& read_so_far) {
    station = {};
    perturbed_robot = {};
    read_station(file, read_so_far, station, perturbed_robot);
  });
  scenario.near_miss = near_miss;
  return {std::move(scenario), std::move(station), std::move(perturbed_robot)};
}

}  // namespace

SimulatedScenario read_simulated_scenario(const std::filesystem::path& file,
                                          std::optional<std::uint64_t> seed, const ControlStages& known) {
  return with_station(
      [&](const SectionReader& station) { return read_scenario(file, seed, station, known); });
}

SimulatedScenario read_simulated_scenario(const std::filesystem::path& file,
                                          const std::vector<std::string>& set,
                                          std::optional<std::uint64_t> seed, const ControlStages& known) {
  return with_station(
      [&](const SectionReader& station) { return read_scenario(file, set, seed, station, known); });
}

SimulatedScenario parse_simulated_scenario(std::string text, const std::filesystem::path& file,
                                           std::optional<std::uint64_t> seed, const ControlStages& known) {
  return with_station([&](const SectionReader& station) {
    return parse_scenario(std::move(text), file, seed, station, known);
  });
}

SimulatedScenario parse_simulated_scenario(const std::shared_ptr<const ConfigNode>& root,
                                           const std::filesystem::path& file, RobotFiles& robots,
                                           std::optional<std::uint64_t> seed, const ControlStages& known) {
  return with_station(
      [&](const SectionReader& station) { return parse_scenario(root, file, robots, seed, station, known); });
}

SimulatedScenario recorded_simulated_scenario(const Recording& recording, const std::filesystem::path& file,
                                              const ControlStages& known) {
  return with_station(
      [&](const SectionReader& station) { return recorded_scenario(recording, file, station, known); });
}

}  // namespace flinch
