#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "systems/config/read_value.h"
#include "systems/framework/recording.h"

namespace flinch {

/// Where two recordings part.
struct FirstDifference {
  std::size_t tick = 0;  ///< number of the sample, from 0
  double time = 0.0;     ///< of the first recording [s]
  /// The first signal that differs there, in the order in which they are computed; "time_ns" where the
  /// samples are of other times, or one recording ends.
  std::string signal;
  std::vector<std::string> others;  ///< signals that differ there as well
};

/// The first sample at which signals that both have differ in a bit; none: they are the same.
std::optional<FirstDifference> first_difference(const Recording& one, const Recording& other);

/// Signals that only one of two recordings has, or that it has with other fields.
std::vector<std::string> signals_of_one(const Recording& one, const Recording& other);

/// A setting that is not the same in all.
struct SettingDifference {
  std::string key;
  std::string unit;
  std::vector<std::optional<std::string>> values;  ///< of each; none: it has no such key
};

/// The settings that are not the same in all lists, in the order in which they first come.
std::vector<SettingDifference> differing_settings(const std::vector<std::vector<ReadValue>>& lists);

/// By how much later the motion of the drives is in `other` [s], so that one fits best on the other: the
/// largest correlation of their velocities, of which at least a third of the shorter one must overlap. Throws
/// SetupError where a recording has no angles of drives, has other drives or never moves.
double delay_by_correlation(const Recording& one, const Recording& other);

}  // namespace flinch
