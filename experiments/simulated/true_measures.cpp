#include "experiments/simulated/true_measures.h"

#include "systems/model/robot_model.h"
#include "systems/robot/kinematics.h"

namespace flinch {

WorkspaceMeasures TrueMeasures::measure(const PlatformMotion& motion) const {
  if (!motion.valid()) return {};
  Kinematics now;
  robot_->kinematics(motion.pose, motion.velocity, now);
  return workspace_measures(*robot_, now);
}

}  // namespace flinch
