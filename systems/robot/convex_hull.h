#pragma once

#include <cstddef>
#include <string>

#include "systems/robot/body.h"

namespace flinch {

/// More points make a hull slow: whoever looks for its nearest one goes through all of them.
inline constexpr std::size_t most_hull_points = 128;
/// A thinner hull is taken for a flat one [m].
inline constexpr double least_hull_thickness = 1e-4;

/// How far the points reach along the direction in which they scatter least [m]; 0: they lie in a plane.
double thickness(const ConvexHull& hull);

/// What is wrong with its points, to go on after "points": too few, too many, not finite, flat. "" if nothing
/// is.
std::string complaint_about_points(const ConvexHull& hull);

}  // namespace flinch
