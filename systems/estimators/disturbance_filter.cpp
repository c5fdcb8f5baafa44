#include "systems/estimators/disturbance_filter.h"

#include <cmath>
#include <string>
#include <vector>

#include "systems/estimators/chain_observability.h"
#include "systems/estimators/innovation_mean.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double settling_time_constants = 10.0;  // of a threefold pole: the rest is 0.3 %
constexpr double resting_deviations = 5.0;        // of the rates of drives that stand still

std::vector<std::string> problems(const DisturbanceFilterSettings& settings) {
  Findings found;
  found.positive("pole", settings.pole, "1/s");
  found.positive("encoder_deviation", settings.encoder_deviation);
  return found.take();
}

/// Shares of an innovation that correct position, velocity T and acceleration T^2, with all poles at `theta`.
struct Gains {
  explicit Gains(double theta)
      : position(1.0 - theta * theta * theta),
        velocity(1.5 * (1.0 - theta) * (1.0 - theta) * (1.0 + theta)),
        acceleration((1.0 - theta) * (1.0 - theta) * (1.0 - theta)) {}
  double position, velocity, acceleration;
};

/// For white noise of deviation 1 in the position: roots of the sums of the squares of their answers to a
/// single wrong sample.
struct NoiseGains {
  double error = 0.0;       ///< deviation of d
  double innovation = 0.0;  ///< and of the innovation
};

NoiseGains noise_gains(double pole, double T) {
  const Gains gains(std::exp(-pole * T));
  const double forgotten = 60.0 / (pole * T);  // steps: of the answer exp(-60) is left
  double q = 0.0, v = 0.0, d = 0.0;
  NoiseGains sums;
  for (int k = 0; k < forgotten; ++k) {
    q += v * T + 0.5 * d * T * T;
    v += d * T;
    const double innovation = (k == 0 ? 1.0 : 0.0) - q;
    q += gains.position * innovation;
    v += gains.velocity * innovation / T;
    d += gains.acceleration * innovation / (T * T);
    sums.error += d * d;
    sums.innovation += innovation * innovation;
  }
  return {std::sqrt(sums.error), std::sqrt(sums.innovation)};
}

}  // namespace

DisturbanceFilter::DisturbanceFilter(std::shared_ptr<const ParallelRobot> robot,
                                     const DisturbanceFilterSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  throw_if_any(problems(settings));
  const NoiseGains noise = noise_gains(settings.pole, to_seconds(settings.sampling.period));
  error_deviation_ = settings.encoder_deviation * noise.error;
  innovation_deviation_ = settings.encoder_deviation * noise.innovation;
  resting_rate_ = resting_deviations * settings.encoder_deviation * settings.pole;
  observability_ = chain_observability<3>();
  settling_time_ = from_seconds(settling_time_constants / settings.pole);
  keep(Every{settings_.sampling.period}, memory_, next_);
}

bool DisturbanceFilter::is_usable(const JointReading& reading, const PlatformMotion& motion,
                                  const Kinematics& at, const DriveTorque& drives) const {
  return reading.valid && usable(reading.active, robot_->drives()) && motion.valid() && at.valid &&
         motion.acquired == reading.acquired && drives.valid && usable(drives.torque, robot_->drives());
}

void DisturbanceFilter::advance(const JointReading& reading, const PlatformMotion& motion,
                                const Kinematics& at, const DriveTorque& drives,
                                const DisturbanceFilterMemory& memory, Time now,
                                DisturbanceFilterMemory& next) const {
  const Sampling& sampling = settings_.sampling;
  const bool is_new =
      is_usable(reading, motion, at, drives) && (!memory.started || reading.acquired > memory.acquired);
  if (!is_new) {
    next = memory.started && sampling.expired(memory.arrived, now) ? DisturbanceFilterMemory() : memory;
    return;
  }
  const bool continued = memory.started && memory.error.allFinite() && memory.velocity.allFinite() &&
                         std::isfinite(memory.innovation) &&
                         !sampling.interrupted(memory.acquired, reading.acquired);
  next.braked = drives.braked;
  if (continued && !drives.braked && !memory.braked) {
    step(memory, reading.active, drives.torque, to_seconds(reading.acquired - memory.acquired), next);
  } else {
    next.position = reading.active;
    next.velocity = at.rates.active;
    const bool opens = memory.braked && !drives.braked;
    if (opens && (next.velocity.array().abs() <= resting_rate_).all()) next.velocity.setZero();
    next.error.setZero(robot_->drives());
    next.innovation = 1.0;
  }
  next.started = true;
  next.since = continued ? memory.since : now;
  next.arrived = now;
  next.acquired = reading.acquired;
  next.pose = motion.pose;
  next.J_x_qa = at.J_x_qa;
}

void DisturbanceFilter::step(const DisturbanceFilterMemory& memory, const JointVector& position,
                             const JointVector& drive_torque, double T, DisturbanceFilterMemory& next) const {
  const Gains gains(std::exp(-settings_.pole * T));
  const JointVector acceleration = modelled_acceleration(memory, drive_torque, T) + memory.error;
  next.position = memory.position + T * memory.velocity + 0.5 * T * T * acceleration;
  next.velocity = memory.velocity + T * acceleration;
  const JointVector innovation = robot_->drive_difference(position, next.position);
  next.position += gains.position * innovation;
  next.velocity += gains.velocity / T * innovation;
  next.error = memory.error + gains.acceleration / (T * T) * innovation;
  const double squares = innovation.squaredNorm() / (innovation_deviation_ * innovation_deviation_);
  next.innovation = innovation_mean(memory.innovation, squares, robot_->drives(), T);
}

/// Of the drives, under a torque that they held for the step after `memory`, in its middle. Zero where the
/// model does not reach.
JointVector DisturbanceFilter::modelled_acceleration(const DisturbanceFilterMemory& memory,
                                                     const JointVector& drive_torque, double T) const {
  const PlatformVector velocity = memory.J_x_qa * memory.velocity;
  const Configuration middle = robot_->space().plus(memory.pose, 0.5 * T * velocity);
  return robot_->drive_acceleration(middle, velocity, drive_torque)
      .value_or(JointVector::Zero(robot_->drives()));
}

void DisturbanceFilter::follow(const DisturbanceFilterMemory& next, const PlatformMotion& measured,
                               const Kinematics& at, PlatformMotion& result) const {
  result = measured;
  if (!measured.valid() || !at.valid) return;
  const bool is_followed = next.started && next.acquired == measured.acquired && next.velocity.allFinite();
  if (is_followed) result.velocity = at.J_x_qa * next.velocity;
}

void DisturbanceFilter::read(const DisturbanceFilterMemory& next, const Kinematics& at, const Dynamics& model,
                             Time now, WrenchEstimate& result) const {
  result = WrenchEstimate();
  result.acquired = next.acquired;
  result.wrench_in_base.setZero(robot_->dof());
  result.drive_torque.setZero(robot_->drives());
  const bool is_usable = next.started && at.valid && model.valid && next.error.allFinite();
  if (!is_usable) return;
  result.valid = now - next.since >= settling_time_;
  const PlatformMatrix from_drives = model.M_x * at.J_x_qa;
  result.wrench_in_base = from_drives * next.error;
  result.drive_torque = at.J_x_qa.transpose() * result.wrench_in_base;  // [SafePR] (6b)
  result.standard_deviation = error_deviation_ * from_drives.rowwise().norm();
  result.health = {.fallen_back = false, .innovation = next.innovation, .observability = observability_};
}

}  // namespace flinch
