#include "systems/safety/drive_check.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/signals/sampling.h"

namespace flinch {

namespace {

constexpr Time at_rest = 8ms;  // before the first drive is tried
constexpr Time shortest_part = 7ms;
constexpr std::array pattern{1.0, -1.0, -1.0, 1.0};  // of the torque: there, back, back and there
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr int watched_parts = 5;  // the four, and one in which the robot comes to rest

/// How the drives' rates change by torques besides those that hold the robot:
/// J_qa,x M_x^-1 J_qa,x^T tau. [SafePR] (4)
JointVector acceleration_by(const JointVector& torque, const Kinematics& at, const Dynamics& model) {
  return at.J_qa_x * model.M_x.llt().solve(at.J_qa_x.transpose() * torque);
}

}  // namespace

DriveCheck::DriveCheck(std::shared_ptr<const ParallelRobot> robot, const DriveCheckSettings& settings)
    : robot_(std::move(robot)),
      settings_(settings),
      part_(whole_periods(std::max(shortest_part, 2 * settings.period), settings.period)) {
  Findings found;
  found.positive("drive check: torque", settings.torque);
  found.require(0.0 < settings.least_gain && settings.least_gain < 1.0,
                "drive check: least_gain must be between 0 and 1");
  found.require(settings.most_gain > 1.0, "drive check: most_gain must be above 1");
  found.require(settings.period > Time::zero(), "drive check: period must be positive");
  throw_if_any(found.take());
}

void DriveCheck::advance(Time now, const Memory& last, const TorqueCommand& asked, const JointReading& angles,
                         const Kinematics& at, const Dynamics& model, const ReactionState& state,
                         const PlatformReference& followed, Memory& next) const {
  next = last;
  const Eigen::Index drives = robot_->drives();
  const bool is_nominal = state.mode == ReactionMode::nominal;
  if (last.status.phase == Phase::passed || (last.status.phase == Phase::failed && is_nominal)) return;
  const bool is_held = is_nominal && followed.valid && followed.finished && at.valid && model.valid &&
                       asked.valid && asked.torque.size() == drives && angles.valid &&
                       angles.active.size() == drives && angles.active.allFinite();
  if (!is_held) {
    next.status.phase = Phase::waiting;
    next.begin = now;
    return;
  }
  if (last.status.phase != Phase::running) {
    if (now - last.begin < at_rest) return;
    next.status = {.phase = Phase::running, .drive = -1, .gain = JointVector::Constant(drives, unknown)};
    try_next(now, angles, asked, next);
  } else if (now - last.begin >= watched_parts * part_) {
    judge(next);
    if (next.status.phase != Phase::running) return;
    try_next(now, angles, asked, next);
  }
  measure(now, angles, next);
  predict(now, asked, at, model, next);
}

void DriveCheck::try_next(Time now, const JointReading& angles, const TorqueCommand& asked,
                          Memory& next) const {
  const DriveCheckStatus known = next.status;
  next = {.status = known, .begin = now, .angle = angles.active, .torque = asked.torque};
  ++next.status.drive;
}

void DriveCheck::measure(Time now, const JointReading& angles, Memory& next) const {
  const double measured = robot_->drive_difference(angles.active, next.angle)[next.status.drive];
  const double t = to_seconds(now - next.begin) / to_seconds(watched_parts * part_);
  const Eigen::Vector4d causes(next.way, 1.0, t, t * t);
  next.squares += causes * causes.transpose();
  next.products += causes * measured;
}

/// Where the drive should be at the next tick, which is a period later.
void DriveCheck::predict(Time now, const TorqueCommand& asked, const Kinematics& at, const Dynamics& model,
                         Memory& next) const {
  JointVector more = asked.torque - next.torque;
  more[next.status.drive] += added(now, next);
  const double T = to_seconds(settings_.period);
  next.way += T * next.rate;
  const double acceleration = acceleration_by(more, at, model)[next.status.drive];
  next.way += 0.5 * T * T * acceleration;
  next.rate += T * acceleration;
}

void DriveCheck::judge(Memory& next) const {
  const double gain = next.squares.ldlt().solve(next.products)[0];
  next.status.gain[next.status.drive] = gain;
  const bool fits = settings_.least_gain <= gain && gain <= settings_.most_gain;
  if (!fits)
    next.status.phase = Phase::failed;
  else if (next.status.drive + 1 == robot_->drives())
    next.status.phase = Phase::passed;
}

double DriveCheck::added(Time now, const Memory& memory) const {
  const auto part = static_cast<std::size_t>((now - memory.begin) / part_);
  return part < pattern.size() ? pattern[part] * settings_.torque : 0.0;
}

void DriveCheck::add_torque(Time now, const Memory& memory, const TorqueCommand& asked,
                            TorqueCommand& result) const {
  result = asked;
  if (memory.status.phase == Phase::running && asked.valid)
    result.torque[memory.status.drive] += added(now, memory);
}

}  // namespace flinch
