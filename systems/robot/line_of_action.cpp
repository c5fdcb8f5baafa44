#include "systems/robot/line_of_action.h"

#include <Eigen/Geometry>
#include <cmath>

namespace flinch {
namespace {

/// A vector of the plane or of space as one of space.
Eigen::Vector3d in_space(const CartesianVector& v) {
  Eigen::Vector3d spatial = Eigen::Vector3d::Zero();
  spatial.head(v.size()) = v;
  return spatial;
}

/// The moment of a platform that turns about the normal of the plane, or about all axes.
Eigen::Vector3d moment_of(const ConfigurationSpace& space, const PlatformVector& wrench) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  moment.tail(space.rotations()) = wrench.tail(space.rotations());
  return moment;
}

}  // namespace

LineOfAction line_of_action(const ConfigurationSpace& space, const PlatformVector& wrench,
                            double least_force) noexcept {
  const int directions = space.translations();
  LineOfAction line;
  line.lever.setZero(directions);
  line.direction.setZero(directions);
  if (!usable(wrench, space.dimension())) return line;
  const Eigen::Vector3d force = in_space(wrench.head(directions));
  const double size = force.norm();
  if (!(size >= least_force) || size <= 0.0) return line;
  line.valid = true;
  line.has_lever = space.rotations() > 0;
  line.direction = (force / size).head(directions);
  if (!line.has_lever) return line;
  const Eigen::Vector3d moment = moment_of(space, wrench);
  line.lever = (force.cross(moment) / (size * size)).head(directions);  // [SafePR] (15), in closed form
  if (moment.norm() > 0.0) line.moment_along_force = std::abs(moment.dot(force)) / (moment.norm() * size);
  return line;
}

double distance_to_line(const LineOfAction& line, const CartesianVector& origin,
                        const CartesianVector& point) noexcept {
  return in_space(point - origin - line.lever).cross(in_space(line.direction)).norm();
}

double angle_between(const CartesianVector& a, const CartesianVector& b) noexcept {
  return std::atan2(in_space(a).cross(in_space(b)).norm(), a.dot(b));
}

}  // namespace flinch
