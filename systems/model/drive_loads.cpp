#include "systems/model/drive_loads.h"

#include "systems/robot/forward_dynamics.h"

namespace flinch {
namespace {

/// J_x_qa^T M_x of the rotations of the acceleration under these torques alone; zero where there is none.
JointVector turning_effort(const Kinematics& at, const Dynamics& model, const JointVector& torque,
                           int translations) {
  const auto n = at.velocity.size();
  const auto acceleration = forward_dynamics(at, model, torque, PlatformVector::Zero(n));
  const auto rotations = n - translations;
  if (!acceleration || rotations == 0) return JointVector::Zero(torque.size());
  return at.J_x_qa.transpose() * (model.M_x.rightCols(rotations) * acceleration->tail(rotations)).eval();
}

}  // namespace

DriveLoads::DriveLoads(const std::shared_ptr<const Mechanism>& robot, const FrictionBoundsSettings& friction)
    : friction_(*robot, friction), translations_(robot->space().translations()) {}

void DriveLoads::follow(const PlatformMotion& motion, const Kinematics& at,
                        const FrictionBoundsMemory& memory, FrictionBoundsMemory& next) const {
  const bool is_new = motion.valid() && at.valid && at.rates.active.allFinite() &&
                      (!memory.started || motion.acquired > memory.acquired);
  if (!is_new) {
    next = memory;
    return;
  }
  friction_.follow(motion.acquired, at.rates.active, memory, next);
}

void DriveLoads::tell(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                      const DriveTorque& drives, const FrictionBoundsMemory& friction,
                      DriveLoad& result) const {
  result = DriveLoad();
  if (!motion.valid() || !at.valid || !model.valid || !drives.valid) return;
  if (drives.torque.size() != drive_count(at) || friction.open.size() != drive_count(at)) return;
  result.acquired = motion.acquired;
  result.rate = at.rates.active;
  result.torque = drives.torque;
  result.friction = at.J_x_qa.transpose() * model.F_fr_x;                     // [SafePR] (6b)
  const PlatformMatrix M_qa = at.J_x_qa.transpose() * model.M_x * at.J_x_qa;  // [SafePR] (5)
  result.inertia = M_qa.rowwise().norm();
  result.turning = turning_effort(at, model, drives.torque, translations_);
  result.friction_bounds = friction_.interval(result.rate, friction);
  result.valid = result.rate.allFinite() && result.torque.allFinite() && result.friction.allFinite() &&
                 result.inertia.allFinite() && result.turning.allFinite();
}

}  // namespace flinch
