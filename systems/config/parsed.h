#pragma once

#include <cstdint>
#include <string>

#include "systems/config/config_node.h"
#include "systems/config/range.h"

namespace flinch {

/// A value from a file, or the complaint about what stands there instead, as it follows the key:
/// "is 'abc'; it must be a number". The value means something only without a complaint.
template <class T>
struct Parsed {
  T value{};
  std::string complaint;
};

/// What stands there, as the beginning of a complaint: "is 'abc'", "is a list".
std::string description(const ConfigNode& node);

/// Smallest size in SI, but 0, whose squares and products can be computed with.
inline constexpr double least_computable = 1e-24;

/// A number without quotes, converted to SI, finite and within `range`, and 0 or of a size that can be
/// computed with, whatever the range.
Parsed<double> parse_number(const ConfigNode& node, const KeyUnit& unit, const Range& range);

/// A whole number in decimal digits, bounds included.
Parsed<int> parse_integer(const ConfigNode& node, int least, int most);
Parsed<std::uint64_t> parse_seed(const ConfigNode& node);

/// true or false, and none of YAML's older spellings such as yes or off.
Parsed<bool> parse_flag(const ConfigNode& node);

/// Text, in quotes or not, that is not empty.
Parsed<std::string> parse_text(const ConfigNode& node);

/// The shortest text that gives the same bits again.
std::string exact_text(double value);

}  // namespace flinch
