#include "systems/framework/recording_check.h"

#include <algorithm>
#include <functional>

#include "systems/foundation/setup_error.h"

namespace flinch::internal {

Field checked_field(const std::string& name, const std::string& unit, const std::string& frame,
                    std::int64_t kind, std::int64_t capacity, std::int64_t resizable) {
  constexpr auto last_kind = static_cast<std::int64_t>(Field::Kind::boolean);
  constexpr auto most = static_cast<std::int64_t>(most_numbers);
  if (kind < 0 || kind > last_kind || capacity < 1 || capacity > most || resizable < 0 || resizable > 1) {
    throw SetupError("the field '" + name + "' is described by numbers that no field has");
  }
  return {name, unit, frame, static_cast<Field::Kind>(kind), static_cast<int>(capacity), resizable == 1};
}

void add_field(const Field& field, RowLayout& layout) {
  const bool is_there = std::any_of(layout.fields.begin(), layout.fields.end(),
                                    [&field](const Field& other) { return other.name == field.name; });
  if (is_there) throw SetupError("there are two fields '" + field.name + "'");
  layout.fields.push_back(field);
  layout.numbers += static_cast<std::size_t>(field.capacity) + (field.resizable ? 2U : 0U);
  if (layout.numbers > most_numbers) {
    throw SetupError("with the field '" + field.name + "' a row has more than " +
                     std::to_string(most_numbers) + " numbers");
  }
}

Time checked_period(std::int64_t ns) {
  if (ns <= 0 || ns > longest_time) throw SetupError("the period is " + std::to_string(ns) + " ns");
  return Time(ns);
}

void check_times(const std::vector<std::int64_t>& times_ns) {
  const auto fault = std::adjacent_find(times_ns.begin(), times_ns.end(), std::greater_equal<>());
  if (fault != times_ns.end()) {
    throw SetupError("sample " + std::to_string(fault - times_ns.begin() + 1) +
                     " is not later than the one before");
  }
  if (!times_ns.empty() && (times_ns.front() < -longest_time || times_ns.back() > longest_time))
    throw SetupError("there are samples of times that no run has: more than 73 years from its start");
}

std::int64_t checked_size(std::int64_t rows, std::int64_t columns, int capacity, const std::string& field) {
  const bool fits =
      rows >= 0 && columns >= 0 && rows <= capacity && columns <= capacity && rows * columns <= capacity;
  if (!fits) throw SetupError("the field '" + field + "' has a sample with an impossible size");
  return rows * columns;
}

}  // namespace flinch::internal
