#include "systems/safety/encoder_monitor.h"

#include <cmath>

namespace flinch {
namespace {

bool fits(const JointVector& vector, int size) { return vector.size() == size && vector.allFinite(); }

bool is_new_reading(const EncoderMonitor& watch, const EncoderTick& tick) {
  return tick.joints.valid && fits(tick.joints.active, tick.robot.drives()) &&
         (watch.angle.size() == 0 || tick.joints.acquired > watch.acquired);
}

JointVector acting_current(const EncoderTick& tick) {
  const bool acts = !tick.braked && tick.drives.valid && fits(tick.drives.current, tick.robot.drives());
  return acts ? tick.drives.current : JointVector();
}

void note_current(const EncoderTick& tick, const JointVector& current, int drive, EncoderStandstill& still) {
  if (tick.braked) still.current.reset();
  if (!still.current && current.size() > 0) still.current = current[drive];
}

void take_reading(EncoderMonitor& watch, const EncoderTick& tick) {
  const bool first = watch.angle.size() == 0;
  watch.mismatch = passive_mismatch(tick.robot, tick.joints, tick.platform, tick.kinematics);
  for (int i = 0; i < tick.robot.drives(); ++i) {
    EncoderStandstill& still = watch.standstill[static_cast<std::size_t>(i)];
    if (first || tick.joints.active[i] != watch.angle[i]) {
      still = {.since = tick.joints.acquired, .current = std::nullopt, .mismatch = watch.mismatch};
    } else if (still.mismatch.size() == 0) {
      still.mismatch = watch.mismatch;
    }
    note_current(tick, watch.current, i, still);
  }
  if (!first) {
    watch.step = tick.robot.drive_difference(tick.joints.active, watch.angle);
    watch.interval = tick.joints.acquired - watch.acquired;
  }
  watch.angle = tick.joints.active;
  watch.acquired = tick.joints.acquired;
}

}  // namespace

Time EncoderMonitor::repeated(Eigen::Index drive) const {
  return angle.size() == 0 ? Time::zero() : acquired - standstill[static_cast<std::size_t>(drive)].since;
}

double EncoderMonitor::unseen_motion(Eigen::Index drive) const {
  const JointVector& before = standstill[static_cast<std::size_t>(drive)].mismatch;
  if (mismatch.size() == 0 || mismatch.size() != before.size()) return 0.0;
  return ParallelRobot::passive_difference(mismatch, before).lpNorm<Eigen::Infinity>();
}

double EncoderMonitor::unseen_current(Eigen::Index drive) const {
  const std::optional<double>& before = standstill[static_cast<std::size_t>(drive)].current;
  return before && current.size() > 0 ? std::abs(current[drive] - *before) : 0.0;
}

// Forward kinematics leaves the pose of the active angles also where the passive ones contradict it.
JointVector passive_mismatch(const ParallelRobot& robot, const JointReading& joints,
                             const PlatformMotion& platform, const Kinematics& kinematics) noexcept {
  const bool solved = platform.valid() || platform.status == PlatformMotion::Status::implausible;
  if (!solved || platform.acquired != joints.acquired) return {};
  if (!joints.passive_valid || !fits(joints.passive, robot.passive_joints())) return {};
  if (platform.valid() && kinematics.reachable)  // that of this pose, evaluated already
    return ParallelRobot::passive_difference(joints.passive, kinematics.joints.passive);
  const InverseSolution implied = robot.inverse_kinematics(platform.pose, robot.home_working_mode());
  if (!implied.reachable) return {};
  return ParallelRobot::passive_difference(joints.passive, implied.joints.passive);
}

void advance(EncoderMonitor& watch, const EncoderTick& tick) noexcept {
  watch.step.resize(0);
  watch.current = acting_current(tick);
  if (is_new_reading(watch, tick)) take_reading(watch, tick);
}

}  // namespace flinch
