#include "systems/robot/robot_deviation.h"

#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/robot/mechanism.h"

namespace flinch {

double scale_of(const JointVector& scales, std::size_t i) {
  const auto index = static_cast<Eigen::Index>(i);
  return index < scales.size() ? scales[index] : 1.0;
}

bool RobotDeviation::none() const {
  const auto all_one = [](const JointVector& scales) { return (scales.array() == 1.0).all(); };
  return all_one(drive_friction_scale) && all_one(passive_friction_scale) && all_one(leg_inertia_scale) &&
         platform_inertia_scale == 1.0 && payload == 0.0;
}

std::shared_ptr<const Mechanism> true_robot(const std::shared_ptr<const Mechanism>& robot,
                                            const RobotDeviation& deviation) {
  if (deviation.none()) return robot;
  std::shared_ptr<const Mechanism> other = robot->deviating(deviation);
  if (!other) {
    throw SetupError("a robot called '" + robot->name() +
                     "' is of a kind that cannot differ from its model: see Mechanism::deviating()");
  }
  return other;
}

}  // namespace flinch
