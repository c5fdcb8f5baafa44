#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_results.h"

namespace flinch {

/// Whether "KEY=VALUE,..." gives several values; false for what parse_key_values() does not take.
bool gives_several_values(const std::string& set);

/// A sweep: the scenario in `file` run once for each value of the keys that have several in `set`, for each
/// combination where there are several such keys, the others held. It is a campaign of single runs, so that
/// each run is bit for bit the one that 'flinch run' makes with these values. `seed` replaces the scenario's.
/// Throws SetupError with all that is wrong with `set` and the scenario.
Campaign read_sweep(const std::filesystem::path& file, const std::vector<std::string>& set,
                    std::optional<std::uint64_t> seed = std::nullopt);

/// The sweep as a table for people: a row a value.
std::string sweep_table(const Campaign& sweep, const CampaignResults& results);

/// The same as one JSON object on one line: {"keys", "rows": [{"value", ...}]}, each row with the figures of
/// verdict_json(). With several keys `value` is an object by key.
std::string sweep_json(const Campaign& sweep, const CampaignResults& results);

/// The command that repeats a run alone, by its keys and values.
using RunCall = std::function<std::string(const std::vector<std::pair<std::string, std::string>>& values)>;

/// The same as one HTML page that needs nothing else: a curve of every figure over the values, a table, and
/// of each run the command that repeats it. `call`: the command that made the sweep.
std::string sweep_page(const Campaign& sweep, const CampaignResults& results, const RunCall& call_of,
                       const std::string& call);

}  // namespace flinch
