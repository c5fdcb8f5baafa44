#include "systems/laws/zero_gravity.h"

#include "systems/robot/contact_jacobian.h"

namespace flinch {

void ZeroGravity::compensate(Time now, const Kinematics& at, const Dynamics& model,
                             TorqueCommand& command) const {
  command = {.computed = now, .valid = false, .torque = JointVector::Zero(drive_count(at))};
  if (!at.valid || !model.valid || model.g_x.size() != at.J_x_qa.rows()) return;
  command.torque = drive_torques(at, model.g_x);
  command.valid = command.torque.allFinite();
}

}  // namespace flinch
