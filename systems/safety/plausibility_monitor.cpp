#include "systems/safety/plausibility_monitor.h"

#include <algorithm>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/safety/askable_checks.h"

namespace flinch {
namespace {

constexpr Time settling = 8ms;      // after the brakes have opened, that belongs to no check
constexpr Time lost_after = 20ms;   // without a reading
constexpr Time there_after = 20ms;  // with one
constexpr Time longest_learning = 1s;

/// What the two commands before have done over the last two intervals: each half of them. None where one of
/// them was no torque.
JointVector acting_torque(const PlausibilityMemory& memory) {
  if (memory.torque.size() == 0 || memory.torque.size() != memory.torque_before.size()) return {};
  return 0.5 * (memory.torque + memory.torque_before);
}

/// Takes in what the gate did at the end of the tick before.
void note(PlausibilityMemory& memory, const GateAction& done, const PlausibilityLimits& limits, Time now) {
  memory.torque_before = memory.torque;
  memory.torque = done.mean_torque;
  command(memory.currents, limits, done.torque);
  remember(memory.rest, now, done.status, done.brake.engage, done.torque);
}

/// Counts the looks with and without readings of something; whether it is lost.
bool is_lost(const PlausibilityTick& tick, bool there, int& seen, int& missing) {
  const int enough = tick.looks(there_after, 5), too_many = tick.looks(lost_after, 5);
  if (there) seen = std::min(seen + 1, enough);
  missing = there ? 0 : std::min(missing + 1, too_many);
  return seen >= enough && missing >= too_many;
}

/// Whether all is known that a sensor which is read tells while nothing moves.
bool has_learned(const PlausibilityMemory& memory, const PlausibilityTick& tick) {
  return (memory.angles.readings == 0 || memory.angles.change.known()) &&
         (memory.currents.readings == 0 || memory.currents.noise.known()) &&
         (!tick.imu.valid || memory.inertial.gyroscope.known()) &&
         (!tick.joints.passive_valid || memory.parity.knows_offset());
}

/// Whether a unit with this doubt still measures what happens to it.
bool tells_motion(ImuFault doubt) {
  return doubt != ImuFault::dropped_out && doubt != ImuFault::frozen && doubt != ImuFault::saturated;
}

}  // namespace

PlausibilityMonitor::PlausibilityMonitor(std::shared_ptr<const ParallelRobot> robot,
                                         const PlausibilityLimits& limits)
    : look_(whole_periods(shortest_look, limits.period)),
      robot_(std::move(robot)),
      limits_(limits),
      mounted_(limits.imu_mount) {
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
  next.looked = now;
  note(next, done, limits_, now);
  next.found = {};
  next.found.valid = true;
  const int settled = periods_in(settling, look_, 4);
  const bool open = status.valid && !status.braked && status.enabled && !next.rest.engage;
  next.free = open ? std::min(last.free + 1, settled) : (status.valid || next.rest.engage ? 0 : last.free);
  next.moved = last.moved || open;
  ImuReading believed = inertial;
  const PlausibilityTick tick{.robot = *robot_,
                              .limits = limits_,
                              .mounted = mounted_,
                              .now = now,
                              .period = look_,
                              .joints = angles,
                              .drives = currents,
                              .torque = acting,
                              .imu = believed,
                              .platform = pose,
                              .kinematics = kinematic,
                              .dynamics = dynamic,
                              .held = !next.moved && status.valid && status.braked,
                              .free = next.free == settled};
  const JointVector acts = limits_.commands_act ? acting_torque(next) : JointVector();
  flinch::advance(next.status, status, next.rest.engage, next.angles, tick, next.found);
  flinch::advance(next.angles, tick, acts, next.found);
  if (next.angles.acquired != last.angles.acquired || !tick.free)
    flinch::advance(next.response, next.angles.unexplained(), next.angles.mean_interval(), acts,
                    next.angles.rates(), tick, next.found);
  flinch::advance(next.currents, tick, next.found);
  if (command.reset || done.reset) next.imu = ImuMonitor();
  flinch::advance(next.imu, past.imu, next.inertial, next.angles, tick, next.found);
  // Without passive encoders nothing else tells the motion: then it may be the encoders that lie.
  const bool is_alone = next.passive_seen == 0 || last.found.passive_lost;
  const bool is_asked = !next.found.imu_left_out || (is_alone && tells_motion(next.found.imu_doubt));
  believed.valid = inertial.valid && is_asked;
  flinch::advance(next.inertial, past.points, next.angles, tick, next.found);
  flinch::advance(next.parity, tick, next.found);
  flinch::advance(next.rest, past.driven, next.angles, tick, next.found);
  next.found.passive_lost = is_lost(tick, angles.passive_valid, next.passive_seen, next.passive_missing);
  next.found.imu_lost = is_lost(tick, inertial.valid, next.imu_seen, next.imu_missing);
  if (tick.held) next.held_for += look_;
  next.found.learning =
      tick.held && next.rest.engage && next.held_for < longest_learning && !has_learned(next, tick);
  next.found.askable = askable_checks(next, tick);
}

void PlausibilityMonitor::note_action(Time now, const PlausibilityMemory& memory, const TorqueCommand& torque,
                                      const BrakeCommand& brakes, const GateStatus& status,
                                      const ResetCommand& command, GateAction& done) const {
  const bool anew = memory.looked == now;  // what was before has been seen at this tick
  const int before = anew ? 0 : done.ticks;
  const JointVector wanted = torque.valid ? torque.torque : JointVector();
  if (before == 0) {
    done.mean_torque = wanted;
  } else if (wanted.size() == done.mean_torque.size()) {
    done.mean_torque += (wanted - done.mean_torque) / (before + 1);
  } else {
    done.mean_torque = JointVector();
  }
  done.ticks = before + 1;
  done.reset = !anew && (done.reset || command.reset);
  done.torque = torque;
  done.brake = brakes;
  done.status = status;
}

}  // namespace flinch
