#include "systems/estimators/direct_method.h"

#include <optional>

#include "systems/signals/driven_share.h"
#include "systems/signals/sample_at.h"

namespace flinch {
namespace {

/// Between two ticks, as if all but the torques changed evenly.
DirectSample interpolated(const Around<DirectSample>& around, Time time) {
  const DirectSample &before = *around.before, &after = *around.after;
  const double later = around.share(time), earlier = 1.0 - later;
  DirectSample result;
  result.acquired = time;
  result.valid = before.valid && after.valid;
  result.braked = before.braked || after.braked;
  result.M_x = earlier * before.M_x + later * after.M_x;
  result.rest = earlier * before.rest + later * after.rest;
  result.rest -= (driven_share(time - before.acquired) - later) * (after.driving - before.driving);
  return result;
}

}  // namespace

DirectSample DirectMethod::sample(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                                  const DriveTorque& drives) const {
  if (!motion.valid() || !at.valid || !model.valid || !drives.valid) return {};
  if (drives.torque.size() != drive_count(at)) return {};
  const PlatformVector F_a = at.J_qa_x.transpose() * drives.torque;
  DirectSample now;
  now.acquired = motion.acquired;
  now.braked = drives.braked;
  now.M_x = model.M_x;
  now.rest = model.C_x * at.velocity + model.g_x + model.F_fr_x - F_a;
  now.driving = F_a;
  now.valid = now.M_x.allFinite() && now.rest.allFinite();
  return now;
}

void DirectMethod::remember(const DirectSample& fresh, History<DirectSample, late_samples>& past) const {
  if (fresh.valid) past.push(fresh);
}

void DirectMethod::estimate(const PlatformAcceleration& measured, const Kinematics& at,
                            const DirectSample& fresh, const History<DirectSample, late_samples>& past,
                            WrenchEstimate& result) const {
  result = WrenchEstimate();
  result.acquired = measured.acquired;
  result.wrench_in_base.setZero(robot_->dof());
  result.drive_torque.setZero(robot_->drives());
  result.health = measured.health;
  if (!measured.valid || !fresh.valid || !measured.acceleration.allFinite()) return;
  const std::optional<DirectSample> then =
      sample_at(measured.acquired, past, &fresh, sampling_, interpolated);
  if (!then) return;
  if (measured.acceleration.size() != robot_->dof()) return;

  result.valid = true;
  if (fresh.braked || then->braked) return;
  result.wrench_in_base = then->M_x * measured.acceleration + then->rest;
  result.drive_torque = at.J_x_qa.transpose() * result.wrench_in_base;  // [SafePR] (6b)
  if (measured.standard_deviation.size() != robot_->dof()) return;
  result.standard_deviation = (then->M_x.cwiseAbs2() * measured.standard_deviation.cwiseAbs2()).cwiseSqrt();
}

}  // namespace flinch
