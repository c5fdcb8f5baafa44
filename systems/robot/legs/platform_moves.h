#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "systems/robot/configuration_space.h"

namespace flinch {

/// What a number of the platform's chart does: stay, move as a coordinate of the platform, or follow from the
/// coordinates by the legs.
enum class ChartRole { fixed, free, follows };

/// How the platform of legs moves: the roles of its six chart numbers (x, y, z) [m], the origin of E, and
/// (rx, ry, rz) [rad], the rotation vector from its orientation at home, in base axes.
struct PlatformMoves {
  ConfigurationSpace space = ConfigurationSpace::Kind::spatial_pose;  ///< Of the free numbers.
  std::array<ChartRole, 6> roles{ChartRole::free, ChartRole::free, ChartRole::free,
                                 ChartRole::free, ChartRole::free, ChartRole::free};
  bool planar = false;  ///< Everything moves in the plane z = 0.

  /// d: how many numbers follow.
  int following() const;
  /// Whether all six are free and the orientation is a quaternion.
  bool whole_pose() const { return space.rotations() == 3; }
};

/// Names of the six chart numbers: "x", ..., "rz".
inline constexpr std::array<std::string_view, 6> chart_names{"x", "y", "z", "rx", "ry", "rz"};

/// Words that a robot file may say at `moves`, besides "coordinates".
std::vector<std::string> moves_words();
/// The meaning of one of `moves_words()`.
PlatformMoves moves_of(const std::string& word);
/// The same for roles of one's own; nothing where no space has these free numbers.
std::optional<PlatformMoves> moves_of(const std::array<ChartRole, 6>& roles);

}  // namespace flinch
