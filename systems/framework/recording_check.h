#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "systems/framework/fields.h"
#include "systems/framework/time.h"

/// What must hold of a recording whoever has written it, so that nothing that reads it needs to trust a
/// number of the file. All throw SetupError saying what does not hold.
namespace flinch::internal {

/// Numbers of a row of one signal at most: a block of samples then takes 64 MiB.
inline constexpr std::size_t most_numbers = 2048;

/// A field as a file describes it.
Field checked_field(const std::string& name, const std::string& unit, const std::string& frame,
                    std::int64_t kind, std::int64_t capacity, std::int64_t resizable);

/// Adds a field to a row, which has room for most_numbers.
void add_field(const Field& field, RowLayout& layout);

/// No time of a recording is further from zero, and no period longer: 73 years. So they can be subtracted and
/// added [ns].
inline constexpr std::int64_t longest_time = std::int64_t{1} << 61;

/// Above zero.
Time checked_period(std::int64_t ns);

/// Each later than the one before.
void check_times(const std::vector<std::int64_t>& times_ns);

/// How many numbers a field with room for `capacity` has in a row that says it has `rows` x `columns`.
std::int64_t checked_size(std::int64_t rows, std::int64_t columns, int capacity, const std::string& field);

}  // namespace flinch::internal
