#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "apps/flinch/command_line.h"
#include "experiments/scenario/scenario.h"

namespace flinch {

class Diagram;

/// flinch run --station simulated. Throws SetupError for bad input.
ExitStatus run_simulated(const RunOptions& options);

/// The same with several values of keys: a run for each, a row for each run.
ExitStatus run_sweep(const RunOptions& options);

/// The closed loop of a scenario: its control path with the simulated station, or, where this program was
/// built without the simulation, with a robot outside. Throws SetupError for all that is wrong with the file.
std::unique_ptr<Diagram> closed_loop(const std::filesystem::path& scenario);

/// Builds the closed loop of a scenario, and returns what was read of it. Throws SetupError as closed_loop().
Scenario check_scenario(const std::filesystem::path& file);

/// Draws the first run of a campaign. Returns what is doubtful about its calibrations. Throws
/// SetupError for all that is wrong with the file, and where this program was built without the simulation.
std::vector<CalibrationWarning> check_campaign(const std::filesystem::path& file);

/// Reads a file of figures for flinch reproduce. Throws SetupError as check_campaign().
void check_figures(const std::filesystem::path& file);

/// The scenario that a recording was made from, or that of the file `control` if it is named. Where the run
/// was simulated, and this program can, its parameters are those of the simulation, too. Throws SetupError
/// naming `file`, where the recording comes from, when it keeps none, and as read_scenario().
Scenario scenario_of(const Recording& recording, const std::filesystem::path& file,
                     const std::filesystem::path& control = {});

}  // namespace flinch
