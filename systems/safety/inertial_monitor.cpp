#include "systems/safety/inertial_monitor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "systems/robot/imu_mount.h"
#include "systems/robot/spatial_motion.h"

namespace flinch {
namespace {

using Motions = Series<SensorPointMotion, 32>;

/// The motions that the encoders tell, one for each look.
struct Told {
  const Motions& motions;
  Time period;
};

const SensorPointMotion* motion_at(const Told& told, Time time) {
  const Motions& motions = told.motions;
  for (std::size_t age = 0; age < motions.held(); ++age) {
    const SensorPointMotion& motion = motions.back(age);
    if (std::chrono::abs(motion.time - time) <= told.period / 2) return motion.known ? &motion : nullptr;
  }
  return nullptr;
}

/// What the encoders tell of the tick before the last: with rates from two intervals, the middle of them.
SensorPointMotion told_by_encoders(const AngleMonitor& angles, const PlausibilityTick& tick) {
  SensorPointMotion motion;
  motion.time = angles.rates_at();
  const JointVector rates = angles.rates();
  const Kinematics& kinematics = tick.kinematics;
  if (rates.size() == 0 || !kinematics.valid || !tick.platform.valid()) return motion;
  const PlatformVector velocity = kinematics.J_x_qa * rates;
  const ConfigurationSpace space = tick.robot.space();
  const SpatialMotion body =
      spatial_motion(space, kinematics.pose, velocity, PlatformVector::Zero(velocity.size()));
  motion.velocity.head(space.translations()) = velocity.head(space.translations());
  motion.velocity += body.angular_velocity.cross(body.axes * tick.mounted.position_in_platform);
  motion.axes = body.axes * tick.mounted.to_sensor.transpose();
  motion.turning = motion.axes.transpose() * body.angular_velocity;
  motion.known = true;
  return motion;
}

/// Standard deviations of velocity and angular velocity that the noise of the angles makes.
struct Spread {
  double velocity = 0.0, turning = 0.0;
};
Spread spread_of(const AngleMonitor& angles, const PlausibilityTick& tick) {
  Spread spread;
  const Eigen::Index translations = tick.robot.space().translations();
  const PlatformMatrix& J = tick.kinematics.J_x_qa;
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const double rate = angles.angle_noise(i, tick) / (std::sqrt(2.0) * tick.T());
    spread.velocity += rate * rate * J.col(i).head(translations).squaredNorm();
    spread.turning += rate * rate * J.col(i).tail(J.rows() - translations).squaredNorm();
  }
  return {std::sqrt(spread.velocity), std::sqrt(spread.turning)};
}

/// How far `value` lies outside of what the encoders said within a tick of `time`, axis by axis; zero within.
Eigen::Vector3d outside_of_tube(const Told& told, Time time, const Eigen::Vector3d& value) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL), high = -low;
  for (const Time apart : {-told.period, Time::zero(), told.period}) {
    const SensorPointMotion* const motion = motion_at(told, time + apart);
    if (motion == nullptr) return Eigen::Vector3d::Zero();
    low = low.cwiseMin(motion->turning);
    high = high.cwiseMax(motion->turning);
  }
  return (value - high).cwiseMax(0.0) + (value - low).cwiseMin(0.0);
}

void judge_turning(InertialMonitor& watch, const Told& told, const PlausibilityTick& tick,
                   const ImuReading& imu, const Spread& spread, Plausibility& found) {
  const Eigen::Vector3d turning = imu.angular_velocity - watch.gyroscope.mean;
  const auto count = static_cast<std::size_t>(tick.looks(4ms, 2));
  watch.turning[watch.turnings++ % count] = outside_of_tube(told, imu.acquired, turning);
  if (!tick.free) watch.turnings = 0;
  if (watch.turnings < count) return;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) mean += watch.turning[k] / static_cast<double>(count);
  const double noise =
      std::hypot(spread.turning, std::max(watch.gyroscope.deviation, 1e-3)) / std::sqrt(count);
  const double limit = tick.limits.inertial * noise + tick.limits.gyroscope_scale * turning.norm();
  note(found, PlausibilityCheck::gyroscope, mean.lpNorm<Eigen::Infinity>() / limit,
       GateFault::motion_contradicted);
}

void take_acceleration(InertialMonitor& watch, std::size_t window, const Eigen::Vector3d& acceleration,
                       Time measured) {
  const Eigen::Vector3d& before = watch.acceleration[(watch.accelerations + window - 1) % window];
  const std::size_t place = watch.accelerations++ % window;
  watch.change[place] = (acceleration - before).norm();
  watch.acceleration[place] = acceleration;
  watch.measured[place] = measured;
}

/// Velocity at `time`, between those of the ticks around it; none where they are not known.
std::optional<Eigen::Vector3d> velocity_at(const Told& told, Time time) {
  const SensorPointMotion* const nearest = motion_at(told, time);
  if (nearest == nullptr || nearest->time == time)
    return nearest ? std::optional(nearest->velocity) : std::nullopt;
  const Time later = time - nearest->time;
  const SensorPointMotion* const other =
      motion_at(told, nearest->time + (later > Time::zero() ? told.period : -told.period));
  if (other == nullptr) return std::nullopt;
  const double share = to_seconds(later) / to_seconds(other->time - nearest->time);
  return nearest->velocity + share * (other->velocity - nearest->velocity);
}

/// The accelerations of a window.
struct SummedUp {
  Time from{};                              ///< of the first
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};  ///< by trapezoids [m/s]
  double variation = 0.0;                   ///< in total, from zero and back [m/s^2]
};
SummedUp summed_up(const InertialMonitor& watch, std::size_t window) {
  const auto place = [&](std::size_t k) { return (watch.accelerations + k) % window; };
  const auto time = [&](std::size_t k) { return watch.measured[place(std::min(k, window - 1))]; };
  SummedUp sum{.from = time(0)};
  for (std::size_t k = 0; k < window; ++k) {
    const Time around = time(k + 1) - time(k == 0 ? 0 : k - 1);
    sum.velocity += 0.5 * to_seconds(around) * watch.acceleration[place(k)];
    if (k > 0) sum.variation += watch.change[place(k)];
  }
  sum.variation += watch.acceleration[place(0)].norm() + watch.acceleration[place(window - 1)].norm();
  return sum;
}

/// The change of velocity over a window, as the encoders tell it and as the accelerometer sums it up. Where
/// the acceleration changes, a sample is a value at an instant, not a mean: hence its total variation.
void judge_velocity(InertialMonitor& watch, const Told& told, const PlausibilityTick& tick,
                    const ImuReading& imu, const Spread& spread, const SensorPointMotion& now,
                    Plausibility& found) {
  const auto window = static_cast<std::size_t>(tick.looks(16ms, 4));
  take_acceleration(watch, window,
                    now.axes * (imu.specific_force - watch.accelerometer.mean) + tick.robot.gravity(),
                    imu.acquired);
  if (!tick.free) watch.accelerations = 0;
  double ratio = 0.0;
  const SummedUp sum = summed_up(watch, window);
  const auto before = velocity_at(told, sum.from), after = velocity_at(told, imu.acquired);
  if (watch.accelerations >= window && before && after) {
    const double noise =
        std::sqrt(2.0) * spread.velocity + tick.T() * std::sqrt(window) * watch.accelerometer.deviation;
    const double apart_by = std::max(tick.limits.acceleration_time, 2.0 * tick.T());
    const double limit = tick.limits.inertial * noise + apart_by * sum.variation;
    const Eigen::Vector3d apart = *after - *before - sum.velocity;
    ratio = apart.head(tick.robot.space().translations()).norm() / limit;
  }
  note(found, PlausibilityCheck::accelerometer, std::min({watch.outside[0], watch.outside[1], ratio}),
       GateFault::motion_contradicted);
  watch.outside = {watch.outside[1], ratio};
}

void learn(InertialMonitor& watch, const ImuReading& imu, const Eigen::Vector3d& gravity,
           const SensorPointMotion& now) {
  watch.gyroscope.add(imu.angular_velocity);
  watch.accelerometer.add(imu.specific_force + now.axes.transpose() * gravity);
}

/// The first sample that waits and of whose instant, and the tick after it, the encoders have told.
const ImuReading* next_sample(const InertialMonitor& watch, const AngleMonitor& angles, Time period) {
  for (const ImuReading& sample : watch.waiting) {
    const bool known = sample.acquired + period / 2 < angles.rates_at();
    if (sample.valid && known && sample.acquired > watch.acquired) return &sample;
  }
  return nullptr;
}

void keep_waiting(InertialMonitor& watch, const ImuReading& imu) {
  const bool is_new = imu.valid && imu.acquired > watch.waiting.back().acquired &&
                      imu.angular_velocity.allFinite() && imu.specific_force.allFinite();
  if (!is_new && watch.waiting.back().valid) return;
  std::move(watch.waiting.begin() + 1, watch.waiting.end(), watch.waiting.begin());
  watch.waiting.back() = imu;
}

}  // namespace

void LearnedBias::add(const Eigen::Vector3d& value) noexcept {
  if (count >= LearnedNoise::most) return;
  sum += value;
  squares += value.cwiseAbs2();
  ++count;
  mean = sum / count;
  const Eigen::Vector3d variance = squares / count - mean.cwiseAbs2();
  deviation = std::sqrt(std::max(variance.maxCoeff(), 0.0));
}

void advance(InertialMonitor& watch, const InertialMonitor::Motions::Past& past, const AngleMonitor& angles,
             const PlausibilityTick& tick, Plausibility& found) noexcept {
  watch.motion.push(told_by_encoders(angles, tick));
  const Motions motions(watch.motion, past);
  const Told told{motions, tick.period};
  keep_waiting(watch, tick.imu);
  const ImuReading* const imu = next_sample(watch, angles, tick.period);
  if (imu == nullptr) return;
  if (imu->acquired - watch.acquired > 3 * tick.period / 2) watch.accelerations = watch.turnings = 0;
  watch.acquired = imu->acquired;
  const SensorPointMotion* const now = motion_at(told, imu->acquired);
  if (now == nullptr) {
    watch.accelerations = watch.turnings = 0;
    return;
  }
  if (tick.held) learn(watch, *imu, tick.robot.gravity(), *now);
  if (!watch.gyroscope.known()) return;
  const Spread spread = spread_of(angles, tick);
  if (found.imu_doubt == ImuFault::none) judge_turning(watch, told, tick, *imu, spread, found);
  judge_velocity(watch, told, tick, *imu, spread, *now, found);
}

}  // namespace flinch
