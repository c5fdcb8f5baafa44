#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "systems/framework/diagram.h"
#include "systems/framework/recording.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/target_command.h"

namespace flinch {

class Spectator;
struct SimulatedScenario;
struct Verdict;

/// The closed loop of a scenario: the simulated station and the control path. The outputs of the diagram are
/// what is recorded; its inputs are what the operator does at a panel, besides what the scenario says of him.
struct Experiment {
  std::unique_ptr<Diagram> diagram;
  InputPort<OperatorCommand> operator_command;
  InputPort<TargetCommand> target;
};

/// Throws SetupError for settings that do not fit together.
Experiment build_experiment(const SimulatedScenario& scenario);

/// Runs the scenario from its start to its end and returns all that was recorded, with what made it as
/// attributes: version, seed, scenario and robot file, steps that missed their accuracy, and `provenance`.
/// `progress` is told now and then which share is done. Throws SetupError as build_experiment() does.
Recording run_experiment(const SimulatedScenario& scenario,
                         const std::map<std::string, std::string>& provenance = {},
                         const std::function<void(double share)>& progress = {});

/// The same, judged while it runs: the verdict that its recording would have. Keeps no recording, so that a
/// run's length takes no memory.
Verdict judge_experiment(const SimulatedScenario& scenario);

/// As run_experiment(), recording only the signals of these names: those that the run has. Nothing says what
/// made it.
Recording run_for_signals(const SimulatedScenario& scenario, const std::vector<std::string>& names);

/// The same, recorded into `file` while it runs, so that its length takes no memory; what it returns reads
/// from there. A `spectator` sees the run while it goes on, and says how fast that is; he changes nothing
/// that is recorded. Throws SetupError also where the file cannot be written.
Recording record_experiment(const SimulatedScenario& scenario, const std::filesystem::path& file,
                            const std::map<std::string, std::string>& provenance = {},
                            const std::function<void(double share)>& progress = {},
                            Spectator* spectator = nullptr);

}  // namespace flinch
