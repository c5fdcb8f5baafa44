#include "systems/model/drive_loads.h"

namespace flinch {

void DriveLoads::tell(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                      const DriveTorque& drives, DriveLoad& result) const {
  result = DriveLoad();
  if (!motion.valid() || !at.valid || !model.valid || !drives.valid) return;
  if (drives.torque.size() != drive_count(at)) return;
  result.acquired = motion.acquired;
  result.rate = at.rates.active;
  result.torque = drives.torque;
  result.friction = at.J_x_qa.transpose() * model.F_fr_x;                     // [SafePR] (6b)
  const PlatformMatrix M_qa = at.J_x_qa.transpose() * model.M_x * at.J_x_qa;  // [SafePR] (5)
  result.inertia = M_qa.rowwise().norm();
  result.valid = result.rate.allFinite() && result.torque.allFinite() && result.friction.allFinite() &&
                 result.inertia.allFinite();
}

}  // namespace flinch
