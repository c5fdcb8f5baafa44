#include "systems/safety/plausibility_monitor.h"

#include <algorithm>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/safety/askable_checks.h"

namespace flinch {
namespace {

constexpr int settling = 8;      // ticks after the brakes have opened that belong to no check
constexpr int lost_after = 20;   // ticks without a reading
constexpr int there_after = 20;  // ticks with one

/// What the two commands before have done over the last two intervals: each half of them. None where one of
/// them was no torque.
JointVector acting_torque(const PlausibilityMemory& memory) {
  if (memory.torque.size() == 0 || memory.torque.size() != memory.torque_before.size()) return {};
  return 0.5 * (memory.torque + memory.torque_before);
}

/// Takes in what the gate did at the end of the tick before.
void note(PlausibilityMemory& memory, const GateAction& done, const PlausibilityLimits& limits, Time now) {
  memory.torque_before = memory.torque;
  memory.torque = done.torque.valid ? done.torque.torque : JointVector();
  command(memory.currents, limits, done.torque);
  remember(memory.rest, now, done.status, done.brake.engage, done.torque);
}

void count(bool there, int& seen, int& missing) {
  if (there) seen = std::min(seen + 1, there_after);
  missing = there ? 0 : std::min(missing + 1, lost_after);
}

bool is_lost(int seen, int missing) { return seen >= there_after && missing >= lost_after; }

}  // namespace

PlausibilityMonitor::PlausibilityMonitor(std::shared_ptr<const ParallelRobot> robot,
                                         const PlausibilityLimits& limits)
    : robot_(std::move(robot)), limits_(limits), mounted_(limits.imu_mount) {
  throw_if_any(problems(limits, robot_->drives()));
}

void PlausibilityMonitor::advance(Time now, const PlausibilityMemory& last, const PlausibilityPast& past,
                                  const GateAction& done, const JointReading& angles,
                                  const DriveReading& currents, const ImuReading& inertial,
                                  const DriveTorque& acting, const ResetCommand& command,
                                  const StationStatus& status, const PlatformMotion& pose,
                                  const Kinematics& kinematic, const Dynamics& dynamic,
                                  PlausibilityMemory& next) const {
  next = last;
  note(next, done, limits_, now);
  next.found = {};
  next.found.valid = true;
  const bool open = status.valid && !status.braked && status.enabled && !next.rest.engage;
  next.free = open ? std::min(last.free + 1, settling) : (status.valid || next.rest.engage ? 0 : last.free);
  next.moved = last.moved || open;
  ImuReading believed = inertial;
  const PlausibilityTick tick{.robot = *robot_,
                              .limits = limits_,
                              .mounted = mounted_,
                              .now = now,
                              .joints = angles,
                              .drives = currents,
                              .torque = acting,
                              .imu = believed,
                              .platform = pose,
                              .kinematics = kinematic,
                              .dynamics = dynamic,
                              .held = !next.moved && status.valid && status.braked,
                              .free = next.free == settling};
  const JointVector acts = limits_.commands_act ? acting_torque(next) : JointVector();
  flinch::advance(next.status, status, next.rest.engage, next.angles, tick, next.found);
  flinch::advance(next.angles, tick, acts, next.found);
  if (next.angles.acquired != last.angles.acquired || !tick.free)
    flinch::advance(next.response, next.angles.unexplained(), next.angles.mean_interval(), acts,
                    next.angles.rates(), tick, next.found);
  flinch::advance(next.currents, tick, next.found);
  if (command.reset) next.imu = ImuWatch();
  flinch::advance(next.imu, past.imu, next.inertial, next.angles, tick, next.found);
  believed.valid = inertial.valid && !next.found.imu_left_out;
  flinch::advance(next.inertial, past.points, next.angles, tick, next.found);
  flinch::advance(next.parity, tick, next.found);
  flinch::advance(next.rest, past.driven, next.angles, tick, next.found);
  count(angles.passive_valid, next.passive_seen, next.passive_missing);
  count(inertial.valid, next.imu_seen, next.imu_missing);
  next.found.passive_lost = is_lost(next.passive_seen, next.passive_missing);
  next.found.imu_lost = is_lost(next.imu_seen, next.imu_missing);
  next.found.askable = askable_checks(next, tick);
}

}  // namespace flinch
