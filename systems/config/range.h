#pragma once

#include <limits>
#include <string>

#include "systems/config/unit.h"

namespace flinch {

/// The finite numbers between two bounds, in SI.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true;
  bool high_included = true;

  /// False for NaN and infinities.
  bool contains(double value) const;

  /// The end of the sentence "it must ...", with the bounds in the unit that the value was written in.
  std::string requirement(const KeyUnit& written) const;
};

inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0.0, .low_included = false};
inline constexpr Range not_negative{.low = 0.0};
inline constexpr Range fraction{.low = 0.0, .high = 1.0};

/// Bounds included.
constexpr Range between(double low, double high) { return {.low = low, .high = high}; }

}  // namespace flinch
