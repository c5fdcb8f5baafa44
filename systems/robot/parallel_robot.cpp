#include "systems/robot/parallel_robot.h"

#include "systems/robot/angles.h"

namespace flinch {

JointVector ParallelRobot::joint_difference(const JointVector& a, const JointVector& b) noexcept {
  if (a.size() != b.size()) return JointVector::Zero(a.size());
  return (a - b).unaryExpr([](double angle) { return wrap_angle(angle); });
}

CartesianVector ParallelRobot::axis_point(BodyId link, double fraction) const noexcept {
  CartesianVector point = CartesianVector::Zero(space_dimension());
  point[0] = fraction * link_length(link);
  return point;
}

}  // namespace flinch
