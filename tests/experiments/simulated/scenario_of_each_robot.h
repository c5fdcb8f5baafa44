#pragma once

#include <array>

namespace flinch::test {

/// A shipped scenario of a collision for each kind of shipped robot, of realistic ones where there is one.
inline constexpr std::array scenario_of_each_robot{
    "platform_collision_realistic",    "five_bar_collision",          "hexapod_collision_realistic",
    "delta_collision_realistic",       "hexa_collision_realistic",    "planar_3rpr_collision_realistic",
    "planar_4rrr_collision_realistic", "linapod_collision_realistic", "tricept_collision_realistic"};

}  // namespace flinch::test
