#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "experiments/simulated/simulated_scenario.h"

namespace flinch {

struct Campaign;

/// One run of a campaign: where it stands in the grid, and what was drawn for it.
struct CampaignRun {
  std::size_t number = 0;      ///< from 0; what is drawn follows from it alone
  std::size_t point = 0;       ///< of the grid
  std::size_t draw = 0;        ///< the same draws are made at every point
  int attempts = 1;            ///< until what was drawn was possible
  std::uint64_t seed = 0;      ///< of the noise
  bool tells_figures = false;  ///< its result has all figures of the verdict
  /// Key and value: of the grid's axes, then of what was drawn. The same keys in all runs of a campaign.
  std::vector<std::pair<std::string, std::string>> values;
  SimulatedScenario scenario;  ///< its text is a whole scenario file
};

/// Draws run `number` of the campaign. Where what was drawn cannot be (a pose out of reach, a body that does
/// not move), it is drawn again, up to `most_attempts` times. Throws SetupError with the last reason, the run
/// and what was drawn for it where none was possible, and at once for keys that fit no scenario.
CampaignRun draw_run(const Campaign& campaign, std::size_t number, int most_attempts = 200);

/// Throws SetupError with what is wrong with keys of the grid and of draws, whatever is drawn, and with
/// values where nothing is drawn: of the first axis that has any, tried with every scenario and every value
/// but not with every combination. Returns what is doubtful about the calibrations of these runs, none twice;
/// where the campaign varies them itself, they are meant to replace what the scenario says.
std::vector<CalibrationWarning> check_keys(const Campaign& campaign);

/// All that can be told of a campaign before its runs: check_keys(), and whether a first run can be drawn.
std::vector<CalibrationWarning> check_campaign(const Campaign& campaign);

}  // namespace flinch
