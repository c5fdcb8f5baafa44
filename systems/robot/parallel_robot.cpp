#include "systems/robot/parallel_robot.h"

#include "systems/robot/angles.h"

namespace flinch {

JointVector ParallelRobot::passive_difference(const JointVector& a, const JointVector& b) noexcept {
  if (a.size() != b.size()) return JointVector::Zero(a.size());
  return (a - b).unaryExpr([](double angle) { return wrap_angle(angle); });
}

}  // namespace flinch
