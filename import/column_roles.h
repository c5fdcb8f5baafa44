#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace flinch {

/// What a column of a log seems to be, by its name alone.
enum class ColumnRole : std::uint8_t {
  unknown,
  time,
  position,
  passive_position,
  velocity,
  current,
  torque,
  angular_velocity,
  specific_force,
  force,
  moment,
  derived,  ///< a point or pose that somebody has computed
};

struct NamedRole {
  ColumnRole role = ColumnRole::unknown;
  int axis = -1;  ///< 0, 1, 2 where the name ends in x, y or z
};

/// By the words that people use in names, English and German, and the unit.
NamedRole role_of(std::string_view name, std::string_view unit);

/// "joint position", for messages.
std::string spoken(ColumnRole role);

}  // namespace flinch
