#pragma once

#include <Eigen/Core>
#include <vector>

#include "systems/robot/body.h"

namespace flinch {

/// A place on the outline of a body, in its frame.
struct TouchPlace {
  Eigen::Vector3d point, normal;  ///< [m]; outwards
  double fraction = 0.0;          ///< of the link's length, from its proximal joint on
  double share = 1.0;             ///< of the outline that it stands for, the average of all places being 1
};

/// `count` places on the side of a capsule, evenly along its axis, with one normal, square to it.
std::vector<TouchPlace> places_along(const Capsule& capsule, const Eigen::Vector3d& normal, int count);

/// Where rays leave a shape that start at the frame's origin in `count` directions, evenly around the plane z
/// = 0 or, with `dimension` 3, over the sphere. Rays that miss it are left out.
std::vector<TouchPlace> places_around(const Shape& shape, int dimension, int count);

/// Places all over the outline of a body in space, about as far from one another as can be.
struct OutlinePlaces {
  std::vector<TouchPlace> places;
  double area_each = 0.0;  ///< of the outline, over the number of places [m^2]
};

/// `count` of them, each with the share of the area that is nearest to it; less where the outline is hardly
/// seen from inside of its shapes. None for a body without shapes.
OutlinePlaces places_by_area(const std::vector<Shape>& shapes, int count);

/// `count` directions, evenly around the plane z = 0 or, with `dimension` 3, over the sphere.
std::vector<Eigen::Vector3d> even_directions(int dimension, int count);

}  // namespace flinch
