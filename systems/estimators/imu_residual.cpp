#include "systems/estimators/imu_residual.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "systems/estimators/differenced_noise.h"
#include "systems/estimators/innovation_mean.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/signals/driven_share.h"
#include "systems/signals/sample_at.h"
#include "systems/signals/stamp_spread.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const ImuResidualSettings& settings) {
  Findings found;
  found.positive("gyroscope_gain", settings.gyroscope_gain, "1/s");
  found.positive("gyroscope_deviation", settings.gyroscope_deviation, "rad/s");
  found.positive("accelerometer_deviation", settings.accelerometer_deviation, "m/s^2");
  found.not_negative("jitter", to_seconds(settings.jitter), "s");
  found.not_negative("stamp_spread", to_seconds(settings.stamp_spread), "s");
  found.positive("rest_speed", settings.rest_speed, "m/s");
  found.positive("rest_rate", settings.rest_rate, "rad/s");
  found.positive("rest_in_a_row", settings.rest_in_a_row);
  found.positive("leaving_rest", settings.leaving_rest);
  found.positive("rest_samples", settings.rest_samples);
  found.positive("largest_innovation", settings.largest_innovation);
  found.finite("mount.position_in_platform", settings.mount.position_in_platform, "m");
  found.finite("mount.angles", settings.mount.angles, "rad");
  return found.take();
}

/// Between two ticks, as if all but the torques changed evenly.
ExpectedMotion interpolated(const Around<ExpectedMotion>& around, Time time) {
  const ExpectedMotion &before = *around.before, &after = *around.after;
  const double later = around.share(time), earlier = 1.0 - later;
  ExpectedMotion result;
  result.acquired = time;
  result.valid = true;
  result.braked = before.braked || after.braked;
  result.is_slow = before.is_slow && after.is_slow;
  result.force_at_rest = earlier * before.force_at_rest + later * after.force_at_rest;
  result.force = earlier * before.force + later * after.force;
  result.rotation = earlier * before.rotation + later * after.rotation;
  result.by_acceleration = earlier * before.by_acceleration + later * after.by_acceleration;
  result.M_x = earlier * before.M_x + later * after.M_x;
  const PlatformVector sooner =
      (driven_share(time - before.acquired) - later) * (after.driving - before.driving);
  const PlatformVector acceleration = result.M_x.llt().solve(sooner);
  result.force += result.by_acceleration.bottomRows<3>() * acceleration;
  result.rotation += result.by_acceleration.topRows<3>() * acceleration;
  return result;
}

/// What the rotation of `between` adds up to from the tick before `time` to it [rad/s].
Eigen::Vector3d turned_since_tick(const Around<ExpectedMotion>& around, Time time) {
  const ExpectedMotion &before = *around.before, &after = *around.after;
  const double since = to_seconds(time - before.acquired);
  const double evenly = 0.5 * since * around.share(time);
  const PlatformVector sooner =
      (driven_time(time - before.acquired) - evenly) * (after.driving - before.driving);
  return since * before.rotation + evenly * (after.rotation - before.rotation) +
         after.by_acceleration.topRows<3>() * after.M_x.llt().solve(sooner);
}

/// Whether both are ticks, one after the other.
bool is_whole_hold(Time from, Time to, const History<ExpectedMotion, late_samples>& past,
                   const ExpectedMotion* fresh) {
  const Around<ExpectedMotion> around = past.around(to, fresh);
  const ExpectedMotion* const before = past.last_before(to);
  return around.before == around.after && before != nullptr && before->acquired == from;
}

/// The mean of dw/dt from one instant to a later one, which is what a gyroscope shows between two samples;
/// none where not all of it is known.
std::optional<Eigen::Vector3d> mean_rotation(Time from, Time to,
                                             const History<ExpectedMotion, late_samples>& past,
                                             const ExpectedMotion* fresh) {
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (Time until = to; until > from;) {
    Around<ExpectedMotion> around = past.around(until, fresh);
    if (around.before == around.after) around.before = past.last_before(until);
    if (!around.known()) return std::nullopt;
    turned += turned_since_tick(around, until);
    if (around.before->acquired < from) turned -= turned_since_tick(around, from);
    until = around.before->acquired;
  }
  return turned / to_seconds(to - from);
}

}  // namespace

ImuResidual::ImuResidual(std::shared_ptr<const ParallelRobot> robot, const ImuResidualSettings& settings)
    : robot_(std::move(robot)), settings_(settings), imu_(settings.mount) {
  throw_if_any(problems(settings));
  keep(Every{settings_.sampling.period}, memory_, next_);
}

void ImuResidual::expect(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
                         const DriveTorque& drives, ExpectedMotion& result) const {
  result = ExpectedMotion();
  if (!motion.valid() || !drives.valid) return;
  const auto acceleration = forward_dynamics(at, model, drives.torque, PlatformVector::Zero(robot_->dof()));
  if (!acceleration) return;
  const ConfigurationSpace space = robot_->space();
  const PlatformVector none = PlatformVector::Zero(robot_->dof());
  const ImuOutput moving =
      imu_output(space, imu_, robot_->gravity(), motion.pose, motion.velocity, *acceleration);
  result.acquired = motion.acquired;
  result.braked = drives.braked;
  result.is_slow = motion.velocity.head(space.translations()).norm() < settings_.rest_speed &&
                   motion.velocity.tail(space.rotations()).norm() < settings_.rest_rate;
  result.force_at_rest = imu_.to_sensor * specific_force(spatial_motion(space, motion.pose, none, none),
                                                         imu_.position_in_platform, robot_->gravity());
  result.force = moving.value.tail<3>();
  result.by_acceleration.resize(6, robot_->dof());
  result.by_acceleration << moving.by_velocity.topRows(3), moving.by_acceleration.bottomRows(3);
  result.rotation = moving.by_velocity.topRows(3) * *acceleration;
  result.M_x = model.M_x;
  result.driving = at.J_qa_x.transpose() * drives.torque;
  result.valid = result.force.allFinite() && result.M_x.allFinite();
}

void ImuResidual::remember(const ExpectedMotion& fresh, History<ExpectedMotion, late_samples>& past) const {
  if (fresh.valid) past.push(fresh);
}

bool ImuResidual::is_usable(const ImuReading& reading) const {
  return reading.valid && usable(reading.angular_velocity, 3) && usable(reading.specific_force, 3);
}

void ImuResidual::advance(const ImuReading& reading, const ExpectedMotion& fresh,
                          const History<ExpectedMotion, late_samples>& past, const ImuResidualMemory& memory,
                          Time now, ImuResidualMemory& next) const {
  const Sampling& sampling = settings_.sampling;
  const bool sees_imu = is_usable(reading);
  const bool is_new = sees_imu && reading.acquired > memory.acquired;
  const ExpectedMotion* const newest = fresh.valid ? &fresh : nullptr;
  std::optional<ExpectedMotion> then =
      is_new ? sample_at(reading.acquired, past, newest, sampling, interpolated) : std::nullopt;
  next = memory;
  next.sees_imu = sees_imu;
  if (!then) {
    if (sampling.expired(memory.arrived, now)) next.started = false;  // its bias stays what it is
    return;
  }
  const bool continued = memory.started && !sampling.interrupted(memory.acquired, reading.acquired);
  const double T = continued ? to_seconds(reading.acquired - memory.acquired) : to_seconds(sampling.period);
  if (!continued) {
    next.rotation_residual.setZero();
    next.angular_velocity = reading.angular_velocity;
    next.expected_force = then->force;
    next.innovation = 1.0;
    next.slow = 0;
  }
  if (continued && !is_whole_hold(memory.acquired, reading.acquired, past, newest)) {
    const auto mean = mean_rotation(memory.acquired, reading.acquired, past, newest);
    if (mean) then->rotation = *mean;
  }
  learn_bias(reading, *then, next);
  if (continued) turn(reading, *then, T, next);
  estimate(reading, *then, T, next);
  next.started = true;
  next.braked = then->braked;
  next.acquired = reading.acquired;
  next.arrived = now;
  next.angular_velocity = reading.angular_velocity;
  next.expected_force = then->force;
}

/// The mean of the last samples at rest, of which none counts more than another at first. It counts when the
/// platform has rested for `leaving_rest` samples more.
void ImuResidual::learn_bias(const ImuReading& reading, const ExpectedMotion& then,
                             ImuResidualMemory& next) const {
  if (!then.is_slow) {
    next.slow = 0;
    next.latest = next.earlier = next.bias;
    return;
  }
  if (++next.slow < settings_.rest_in_a_row) return;
  AccelerometerBias& latest = next.latest;
  if (latest.samples < 2 * settings_.rest_samples) ++latest.samples;
  latest.value += (reading.specific_force - then.force_at_rest - latest.value) / latest.samples;
  if (next.slow < settings_.rest_in_a_row + settings_.leaving_rest) return;
  next.slow = settings_.rest_in_a_row;
  next.bias = next.earlier;
  next.earlier = next.latest;
}

void ImuResidual::turn(const ImuReading& reading, const ExpectedMotion& then, double T,
                       ImuResidualMemory& next) const {
  const double a = std::exp(-settings_.gyroscope_gain * T);
  const Eigen::Vector3d unexplained = (reading.angular_velocity - next.angular_velocity) / T - then.rotation;
  next.rotation_residual = unexplained + a * (next.rotation_residual - unexplained);
}

/// Least squares for the acceleration that explains both residuals, and the wrench that causes it.
void ImuResidual::estimate(const ImuReading& reading, const ExpectedMotion& then, double T,
                           ImuResidualMemory& next) const {
  Eigen::Matrix<double, 6, 1> residual, weight;
  residual << next.rotation_residual, reading.specific_force - next.bias.value - then.force;
  const double a = std::exp(-settings_.gyroscope_gain * T);
  // Stamps that err make of a rotation dw/dt times their deviation.
  const double stamps = uniform_deviation(settings_.stamp_spread);
  const double turned = std::hypot(settings_.gyroscope_deviation, stamps * then.rotation.norm());
  const double turning = turned * differenced_noise(a, T);
  const double slope = (then.force - next.expected_force).norm() / T;
  const double late = std::max(to_seconds(settings_.jitter), stamps);
  const double pushing = std::hypot(settings_.accelerometer_deviation, late * slope);
  weight << Eigen::Vector3d::Constant(1.0 / turning), Eigen::Vector3d::Constant(1.0 / pushing);

  const ImuOutput::Jacobian weighted = weight.asDiagonal() * then.by_acceleration;
  const PlatformMatrix information = weighted.transpose().lazyProduct(weighted);
  const Eigen::LLT<PlatformMatrix> cholesky(information);
  const PlatformMatrix covariance =
      cholesky.solve(PlatformMatrix::Identity(robot_->dof(), robot_->dof()).eval());
  const PlatformVector acceleration =
      covariance * (weighted.transpose() * weight.cwiseProduct(residual)).eval();
  next.wrench = then.M_x * acceleration;
  const int left = 6 - robot_->dof();
  if (left > 0) {
    const double squares = (weight.cwiseProduct(residual) - weighted * acceleration).squaredNorm();
    next.innovation = innovation_mean(next.innovation, squares, left, T);
  }
  const PlatformMatrix spread = then.M_x * covariance * then.M_x.transpose();
  next.standard_deviation = spread.diagonal().cwiseMax(0.0).cwiseSqrt();
}

void ImuResidual::read(const ImuResidualMemory& next, const ExpectedMotion& fresh, const Kinematics& at,
                       WrenchEstimate& result) const {
  result = WrenchEstimate();
  result.acquired = next.started ? next.acquired : Time::zero();
  result.wrench_in_base.setZero(robot_->dof());
  result.drive_torque.setZero(robot_->drives());
  const bool knows = next.started && next.bias.samples >= settings_.rest_samples && next.wrench.allFinite();
  const bool is_monitored = robot_->dof() < 6;
  const bool agrees = !is_monitored || next.innovation <= settings_.largest_innovation;
  result.valid = knows && agrees && next.sees_imu && fresh.valid && at.valid;
  result.health.innovation = is_monitored ? next.innovation : 0.0;
  if (!result.valid || next.braked || fresh.braked) return;
  result.wrench_in_base = next.wrench;
  result.drive_torque = at.J_x_qa.transpose() * next.wrench;  // [SafePR] (6b)
  result.standard_deviation = next.standard_deviation;
}

}  // namespace flinch
