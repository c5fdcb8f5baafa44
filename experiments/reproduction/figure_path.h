#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace flinch {

/// A number in a JSON object, by a path such as
///   "contacts[0].detection_ms", "groups[body=platform, estimator=momentum_observer].median_ms",
///   "most groups[body=platform].removed_max_ms", "least ...", "sum groups.detected":
/// keys with points between them; of a list the entry of that number, counted from 0, or the first whose keys
/// have these values. "most", "least" and "sum" take all entries that have them, and a list without brackets
/// whole.
/// None where nothing is there, or no number.
std::optional<double> figure_at(const nlohmann::json& object, const std::string& path);

/// What is wrong with a path; "" if nothing is.
std::string problem_with_path(const std::string& path);

}  // namespace flinch
