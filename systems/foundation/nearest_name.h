#pragma once

#include <span>
#include <string>
#include <string_view>

namespace flinch {

/// The one of `known` that `name` most likely was meant to be (smallest edit distance), or "" when none is
/// near.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

/// All names, with commas between them.
std::string listed(std::span<const std::string> names);

/// "; known are: " and all names; empty where there are none.
std::string known_names(std::span<const std::string> known);

/// "; did you mean 'x'?" for the nearest known name, or a list of all known names when none is near.
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

}  // namespace flinch
