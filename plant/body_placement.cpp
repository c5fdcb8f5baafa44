#include "plant/body_placement.h"

namespace flinch {

Placement body_placement(const Mechanism& robot, const Kinematics& now, BodyId body) noexcept {
  const int directions = robot.space_dimension();
  const auto point = [&](const Eigen::Vector3d& in_body) {
    Eigen::Vector3d spatial = Eigen::Vector3d::Zero();
    spatial.head(directions) = robot.point_on_body(now, body, in_body.head(directions));
    return spatial;
  };
  Placement at;
  at.origin = point(Eigen::Vector3d::Zero());
  for (int axis = 0; axis < directions; ++axis) {
    at.axes.col(axis) = point(Eigen::Vector3d::Unit(axis)) - at.origin;
  }
  return at;
}

}  // namespace flinch
