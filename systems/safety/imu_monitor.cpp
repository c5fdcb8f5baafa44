#include "systems/safety/imu_monitor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "systems/robot/forward_dynamics.h"
#include "systems/robot/imu_output.h"
#include "systems/safety/tick_motions.h"
#include "systems/signals/driven_share.h"

namespace flinch {
namespace {

constexpr Time dropped_after = 5ms;  // without a reading
constexpr Time back_after = 20ms;    // with one
constexpr int frozen_after = 2;      // repetitions of all axes of a part, of both parts together
constexpr int saturated_after = 5;   // repetitions of one axis
constexpr Time judged = 16ms;        // of the samples of so long, half must be contradicted
constexpr Time quarantine = 10ms;    // after two that were contradicted
constexpr double jitter = 3e-4;      // of stamps, where they are exact [s]
constexpr double scale = 0.01;       // share of a rate that may be missing
constexpr Time forgiven_after = 1s;  // of motion in which nothing is wrong with it
constexpr double telling = 1.0;      // acceleration of the platform in which it would show [m/s^2]
constexpr double believed = 2.0;     // times what the encoders show
constexpr double significant = 3.0;  // deviations

/// Takes in what encoders and model say of this tick.
void take_motion(ImuMonitor& watch, const PlausibilityTick& tick) {
  const Kinematics& kinematics = tick.kinematics;
  const int n = tick.robot.dof();
  const bool known = tick.free && tick.platform.valid() && kinematics.valid && tick.torque.valid &&
                     !tick.torque.braked && tick.platform.pose.size() == tick.robot.space().stored();
  const bool is_new = watch.motion.count == 0 || tick.platform.acquired > watch.motion.newest.time;
  if (known && !is_new) return;
  const auto acceleration =
      known ? forward_dynamics(kinematics, tick.dynamics, tick.torque.torque, PlatformVector::Zero(n))
            : std::nullopt;
  const bool goes_on = watch.motion.count > 0 &&
                       tick.platform.acquired - watch.motion.newest.time < 3 * tick.period / 2 &&
                       acceleration;
  if (!goes_on) watch.motion.clear();
  if (!acceleration) return;
  TickMotion motion{tick.platform.acquired, padded(tick.platform.pose), padded(tick.platform.velocity),
                    Padded<max_dof>::Zero(), padded(*acceleration)};
  if (goes_on) {
    const Configuration before = watch.motion.newest.pose.head(tick.platform.pose.size());
    motion.step = padded(tick.robot.difference(tick.platform.pose, before));
  }
  watch.motion.push(motion);
}

/// Standard deviations of the pose's coordinates, from the noise of the angles.
Padded<max_dof> pose_deviation(const AngleMonitor& angles, const PlausibilityTick& tick) {
  const PlatformMatrix& J = tick.kinematics.J_x_qa;
  PlatformVector squares = PlatformVector::Zero(J.rows());
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const double noise = angles.angle_noise(i, tick);
    squares += noise * noise * J.col(i).cwiseAbs2();
  }
  return padded<max_dof>(squares.cwiseSqrt());
}

constexpr int widest = 6;  // of parabolas

/// parabola_weight(h, i) at [h][|i|].
constexpr auto parabola_weights = [] {
  std::array<std::array<double, widest>, widest + 1> weights{};
  for (int h = 1; h <= widest; ++h) {
    for (int i = 0; i < h; ++i)
      weights[static_cast<std::size_t>(h)][static_cast<std::size_t>(i)] = parabola_weight(h, i);
  }
  return weights;
}();

/// Accelerations of the platform around the motion of `age`.
struct Accelerations {
  Padded<max_dof> shown;  ///< of the parabola through 2 h + 1 poses
  Padded<max_dof> model;  ///< what the drives alone make of it

  Padded<max_dof> unexplained() const { return shown - model; }
};
Accelerations accelerations(const TickMotions& motions, int age, int h) {
  const auto& weights = parabola_weights[static_cast<std::size_t>(h)];
  Padded<max_dof> steps = Padded<max_dof>::Zero(), model = steps;
  for (int i = 1 - h; i < h; ++i) {
    const TickMotion& at = motions.back(static_cast<std::size_t>(age - i));
    const TickMotion& after = motions.back(static_cast<std::size_t>(age - i - 1));
    const double weight = weights[static_cast<std::size_t>(std::abs(i))];
    steps += weight * (after.step - at.step);
    model += weight * at.acceleration;
  }
  return {steps / (motions.T * motions.T), model};
}
Padded<max_dof> unexplained(const TickMotions& motions, int age, int h) {
  return accelerations(motions, age, h).unexplained();
}

/// Deviation of that for a pose of deviation 1, of parabolas: sqrt(720 / (N (N^2 - 1)(N^2 - 4))) / T^2.
double parabola_deviation(int h, double T) {
  const double N = 2.0 * h + 1.0;
  return std::sqrt(720.0 / (N * (N * N - 1.0) * (N * N - 4.0))) / (T * T);
}

/// Velocity at the motion of `age`: slope of the line through 2 h + 1 poses.
Padded<max_dof> line_velocity(const TickMotions& motions, int age, int h) {
  Padded<max_dof> apart = Padded<max_dof>::Zero(), sum = apart;
  double squares = 0.0;
  for (int i = 1; i <= h; ++i) {  // x_{+i} - x_{-i}
    apart += motions.back(static_cast<std::size_t>(age - i)).step +
             motions.back(static_cast<std::size_t>(age + i - 1)).step;
    sum += i * apart;
    squares += 2.0 * i * i;
  }
  return sum / (squares * motions.T);
}
double line_deviation(int h, double T) {
  return 1.0 / (std::sqrt(h * (h + 1.0) * (2.0 * h + 1.0) / 3.0) * T);
}

/// The motion at an instant, and by how much its acceleration is in doubt, see `driven_uncertainty`.
struct MotionThen {
  TickMotion motion;
  Padded<max_dof> rising = Padded<max_dof>::Zero();
};

/// At `time`, between those of `age` and of the tick before or after it.
MotionThen motion_at(const TickMotions& motions, int age, Time time, const ConfigurationSpace& space) {
  const auto nearest = static_cast<std::size_t>(age);
  const Time later = time - motions.back(nearest).time;
  if (later == Time::zero()) return {motions.back(nearest)};
  const TickMotion& before = motions.back(later > Time::zero() ? nearest : nearest + 1);
  const TickMotion& after = motions.back(later > Time::zero() ? nearest - 1 : nearest);
  const double share = to_seconds(time - before.time) / to_seconds(after.time - before.time);
  const Padded<max_dof> step = after.acceleration - before.acceleration;
  MotionThen then{before, driven_uncertainty(time - before.time) * step};
  then.motion.time = time;
  then.motion.pose =
      padded(space.plus(before.pose.head(space.stored()), share * after.step.head(space.dimension())));
  then.motion.velocity += share * (after.velocity - before.velocity);
  then.motion.acceleration += driven_share(time - before.time) * step;
  return then;
}

/// A range that grows by what is significant.
struct Range {
  double low = 0.0, high = 0.0;
  void include(double value, double deviation) {
    if (std::abs(value) < significant * deviation) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double outside(double value) const { return std::max({value - high, low - value, 0.0}); }
};

using Rows = Eigen::Matrix<double, 3, max_dof>;

/// What a sample can be compared with.
struct Comparison {
  const TickMotions& motions;
  int age;                      ///< of the motion nearest to its instant
  int ahead;                    ///< motions after it that count
  double later;                 ///< than that motion [s]
  double spacing;               ///< since the sample before [s]
  Padded<max_dof> deviation;    ///< of the pose
  Padded<max_dof> velocity;     ///< line_velocity(motions, age, ahead)
  ImuSpread noise;              ///< of the unit at rest
  double spread;                ///< of the stamps' errors [s]
  double wrong;                 ///< time by which a stamp may err [s]
  double limit;                 ///< in deviations
  Rows turning = Rows::Zero();  ///< how what is expected of the unit changes with velocity
  Rows force = Rows::Zero();    ///< likewise with acceleration
};

/// Of what `rows` make of a pose.
Eigen::Vector3d deviations(const Rows& rows, const Padded<max_dof>& deviation) {
  return (rows * deviation.asDiagonal()).rowwise().norm();
}

/// Whether `beyond` is no more than what a sensor's own noise makes, with `unsure` besides. Then nothing else
/// needs to be asked: limits are never less, and what the encoders show only takes from it.
bool is_own_noise(const Eigen::Vector3d& beyond, double noise, double limit, double unsure) {
  return beyond.lpNorm<Eigen::Infinity>() <= limit * noise + limit / 5.0 * unsure;
}

/// What a sensor says of the acceleration beyond the model, in its axes.
struct Claim {
  const Rows& rows;        ///< from the platform's acceleration
  Eigen::Vector3d beyond;  ///< what the model expects
  Eigen::Vector3d slope;   ///< d/dt of what it expects
  Eigen::Vector3d rising;  ///< doubt about what the drives make of it
  double noise;            ///< deviation of a sample
  double apart;            ///< what two stamps that err otherwise make of it at most
};

/// Whether a sensor claims what the encoders, who show `around` beyond the model, do not confirm.
bool contradicted(const Comparison& at, const Padded<max_dof>& around, const Claim& claim) {
  const int wide = at.motions.wide, narrow = at.motions.narrow;
  const double unsure = at.wrong * claim.slope.norm() + claim.rising.norm() + 5.0 / at.limit * claim.apart;
  if (is_own_noise(claim.beyond, claim.noise, at.limit, unsure)) return false;
  const Eigen::Vector3d ahead = claim.rows * around;
  const Eigen::Vector3d long_since = claim.rows * unexplained(at.motions, at.age - at.ahead + wide, wide);
  const Eigen::Vector3d lately = claim.rows * unexplained(at.motions, at.age - at.ahead + narrow, narrow);
  const Eigen::Vector3d sigma = deviations(claim.rows, at.deviation);
  const double T = at.motions.T;
  const double of_ahead = parabola_deviation(at.ahead, T), of_wide = parabola_deviation(wide, T);
  const double of_narrow = parabola_deviation(narrow, T);
  for (int axis = 0; axis < 3; ++axis) {
    Range range;
    range.include(ahead[axis], of_ahead * sigma[axis]);
    range.include(long_since[axis], of_wide * sigma[axis]);
    range.include(lately[axis], of_narrow * sigma[axis]);
    range.low *= believed;
    range.high *= believed;
    const double limit = at.limit * std::hypot(of_wide * sigma[axis], claim.noise) + at.limit / 5.0 * unsure;
    if (range.outside(claim.beyond[axis]) > limit) return true;
  }
  return false;
}

/// What the accelerometer claims in the latest sample.
Claim force_claim(const Comparison& at, const ImuErrors& errors) {
  const ImuError& now = errors.back(0);
  return {at.force, now.force, now.force_slope, now.rising, at.noise.force, 0.0};
}

/// What the gyroscope claims by its change from the sample before; nothing in a first sample.
Claim turning_claim(const Comparison& at, const ImuErrors& errors) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  Claim claim{at.turning, none, none, none, std::sqrt(2.0) * at.noise.turning / at.spacing, 0.0};
  if (errors.held() < 2) return claim;
  const ImuError &now = errors.back(0), &before = errors.back(1);
  const Eigen::Vector3d change =
      now.turning + now.expected_turning - before.turning - before.expected_turning;
  claim.beyond = change / at.spacing - now.turning_slope;
  claim.slope = (now.turning_slope - before.turning_slope) / at.spacing;
  claim.apart = at.spread * now.turning_slope.norm() / at.spacing;
  return claim;
}

/// Whether the gyroscope does.
bool turning_contradicted(const Comparison& at, const ImuError& error) {
  const Eigen::Vector3d smooth = at.turning * at.velocity;
  const double unsure = scale * smooth.norm() + at.wrong * error.turning_slope.norm();
  if (is_own_noise(error.turning, at.noise.turning, at.limit, unsure)) return false;
  const Eigen::Vector3d short_line = at.turning * line_velocity(at.motions, at.age, 1);
  const int longer = std::min(at.age, 2);
  const Eigen::Vector3d longer_line = at.turning * line_velocity(at.motions, at.age, longer);
  const Eigen::Vector3d sigma = deviations(at.turning, at.deviation);
  const double T = at.motions.T;
  const double of_rate = std::hypot(line_deviation(at.ahead, T), at.later * parabola_deviation(at.ahead, T));
  for (int axis = 0; axis < 3; ++axis) {
    Range range;
    range.include(short_line[axis] - smooth[axis], line_deviation(1, T) * sigma[axis]);
    range.include(longer_line[axis] - smooth[axis], line_deviation(longer, T) * sigma[axis]);
    const double limit =
        at.limit * std::hypot(of_rate * sigma[axis], at.noise.turning) + at.limit / 5.0 * unsure;
    if (range.outside(error.turning[axis]) > limit) return true;
  }
  return false;
}

/// Whether it is the unit whose rate has left the model of late, not the encoders, whose line has no jumps.
bool unit_left_model(const Comparison& at, const ImuErrors& errors) {
  const auto vote = static_cast<std::size_t>(at.motions.vote);
  const int h = at.motions.most_ahead;
  if (errors.held() <= vote) return false;
  const Eigen::Vector3d error = errors.back(0).turning;
  if ((error - errors.back(1).turning).norm() > 0.85 * error.norm()) return true;
  const int before = at.age + static_cast<int>(vote);  // with what was wrong with the model until then
  Padded<max_dof> model = static_cast<double>(vote) * unexplained(at.motions, before + h, h);
  for (std::size_t k = 0; k < vote; ++k)
    model += at.motions.back(static_cast<std::size_t>(at.age) + k).acceleration;
  const Padded<max_dof> change = at.velocity - line_velocity(at.motions, before, at.ahead);
  const Eigen::Vector3d encoders = at.turning * (change - at.motions.T * model);
  const Eigen::Vector3d unit = encoders + errors.back(0).turning - errors.back(vote).turning;
  return unit.norm() > believed * encoders.norm();
}

/// Age of the motion nearest to `time`; none where there is not enough after and before it.
std::optional<int> nearest_age(const TickMotions& motions, Time time) {
  const int youngest = periods_in(2ms, motions.period), oldest = periods_in(9ms, motions.period);
  const auto needed = static_cast<std::size_t>(periods_in(24ms, motions.period));
  int age = 0;
  while (age <= oldest && age < static_cast<int>(motions.held()) &&
         motions.back(static_cast<std::size_t>(age)).time - time > motions.period / 2)
    ++age;
  if (age < youngest || age > oldest || motions.held() < needed) return std::nullopt;
  return age;
}

/// Compares the sample with the motion of its instant, where that is known; whether it is contradicted.
void judge(ImuMonitor& watch, const TickMotions& motions, const ImuErrors& errors,
           const InertialMonitor& learned, const AngleMonitor& angles, const PlausibilityTick& tick,
           const ImuReading& reading, const ImuSpread& rest) {
  const std::optional<int> nearest = nearest_age(motions, reading.acquired);
  if (!nearest) {
    watch.errors.clear();
    watch.late = false;
    return;
  }
  const int age = *nearest;
  const ConfigurationSpace space = tick.robot.space();
  const auto [then, rising] = motion_at(motions, age, reading.acquired, space);
  const int ahead = std::min(age, motions.most_ahead), n = space.dimension();
  const Time spacing = errors.held() > 0 ? reading.acquired - watch.before.acquired : tick.period;
  const ImuOutput output =
      imu_output(space, tick.mounted, tick.robot.gravity(), then.pose.head(space.stored()),
                 then.velocity.head(n), then.acceleration.head(n));
  Comparison at{.motions = motions,
                .age = age,
                .ahead = ahead,
                .later = to_seconds(then.time - motions.back(static_cast<std::size_t>(age)).time),
                .spacing = to_seconds(spacing),
                .deviation = pose_deviation(angles, tick),
                .velocity = line_velocity(motions, age, ahead),
                .noise = {std::max(rest.force, 1e-3), std::max(rest.turning, 1e-4)},
                .spread = to_seconds(tick.limits.stamp_spread),
                .wrong = std::max(jitter, 0.5 * to_seconds(tick.limits.stamp_spread)),
                .limit = 0.5 * tick.limits.inertial};
  at.turning.leftCols(n) = output.by_velocity.topRows<3>();
  at.force.leftCols(n) = output.by_acceleration.bottomRows<3>();
  const Accelerations around = accelerations(motions, age, ahead);
  ImuError error;
  error.spacing = spacing;
  error.expected_force = output.value.tail<3>();
  error.expected_turning = at.turning * (at.velocity + at.later * around.shown);
  error.force = reading.specific_force - learned.accelerometer.mean - error.expected_force;
  error.turning = reading.angular_velocity - learned.gyroscope.mean - error.expected_turning;
  if (errors.held() > 0)
    error.force_slope = (error.expected_force - errors.back(0).expected_force) / at.spacing;
  error.turning_slope = at.turning * then.acceleration;
  error.rising = at.force * rising;
  error.stamp_spread = at.spread;
  const TickPlace now = place_of(motions, then.time), before = place_of(motions, then.time - spacing);
  error.force_unseen =
      error.force - at.force * unexplained_change(motions, before, now) / (tick.T() * at.spacing);
  error.turning_unseen =
      error.turning + error.expected_turning -
      at.turning *
          (step_from(motions, now) + step_from(motions, place_of(motions, then.time - tick.period))) /
          (2.0 * tick.T());
  watch.errors.push(error);
  watch.errors.newest.jumps = jumped(errors, 0, rest, watch.usual);
  watch.usual.follow(errors, rest);
  const bool is_rest = at.noise.force == rest.force && at.noise.turning == rest.turning;
  if (is_rest ? watch.errors.newest.jumps : jumped(errors, 0, at.noise)) at.limit *= 0.5;
  const bool turning = turning_contradicted(at, error);
  watch.blamed = turning && (watch.blamed || unit_left_model(at, errors));
  const Padded<max_dof> unexplained = around.unexplained();
  watch.errors.newest.contradicted = contradicted(at, unexplained, force_claim(at, errors)) ||
                                     contradicted(at, unexplained, turning_claim(at, errors)) || watch.blamed;
  watch.late = is_late(errors, {deviations(at.force, at.deviation), deviations(at.turning, at.deviation)},
                       at.noise, tick.period);
}

/// How often each axis has said the same, and whether that is more than chance makes.
ImuFault repetition(ImuMonitor& watch, const InertialMonitor& learned, const ImuReading& reading) {
  Eigen::Matrix<double, 6, 1> now, last;
  now << reading.angular_velocity, reading.specific_force;
  last << watch.before.angular_velocity, watch.before.specific_force;
  watch.largest = (0.9 * watch.largest).cwiseMax(last.cwiseAbs());
  bool ends = false;
  for (int i = 0; i < 6; ++i) {
    int& repeats = watch.repeats[static_cast<std::size_t>(i)];
    repeats = now[i] == last[i] ? repeats + 1 : 0;
    ends = ends || (repeats >= saturated_after && std::abs(now[i]) >= watch.largest[i]);
  }
  const bool has_noise = learned.gyroscope.deviation > 1e-6 && learned.accelerometer.deviation > 1e-5;
  if (!has_noise) return ImuFault::none;
  const auto [w1, w2, w3, f1, f2, f3] = watch.repeats;
  const int turning = std::min({w1, w2, w3}), force = std::min({f1, f2, f3});
  if (turning + force >= frozen_after) return ImuFault::frozen;
  return ends ? ImuFault::saturated : ImuFault::none;
}

void count_missing(ImuMonitor& watch, const PlausibilityTick& tick, bool valid) {
  const int back = tick.looks(back_after, 5), gone = tick.looks(dropped_after, 2);
  if (valid) watch.seen = std::min(watch.seen + 1, back);
  watch.missing = valid ? 0 : std::min(watch.missing + 1, gone);
  const bool dropped = watch.seen >= back && watch.missing >= gone;
  if (dropped && watch.doubt == ImuFault::none) watch.doubt = ImuFault::dropped_out;
  if (dropped) watch.seen = 0;
  if (watch.doubt == ImuFault::dropped_out && watch.seen >= back) watch.doubt = ImuFault::none;
}

int lately_contradicted(const ImuErrors& errors) {
  int lately = 0;
  for (std::size_t age = 0; age < std::min<std::size_t>(4, errors.held()); ++age)
    lately += errors.back(age).contradicted ? 1 : 0;
  return lately;
}

/// Believes a unit again that has said what is expected of it for long enough, while the platform was
/// accelerated; `wrong`: what is wrong with it now.
void forgive(ImuMonitor& watch, const PlausibilityTick& tick, const ImuErrors& errors, ImuFault wrong) {
  const bool lasts = watch.doubt != ImuFault::none && watch.doubt != ImuFault::dropped_out;
  if (!lasts || wrong != ImuFault::none || watch.late || lately_contradicted(errors) > 0) {
    watch.honest = 0;
    return;
  }
  const double acceleration = watch.motion.newest.acceleration.head(tick.robot.space_dimension()).norm();
  if (errors.held() > 0 && acceleration > telling) ++watch.honest;
  if (watch.honest < tick.looks(forgiven_after)) return;
  watch.doubt = ImuFault::none;
  watch.honest = 0;
}

/// Leaves out what has just been contradicted, and what follows soon after two of them.
void mask(ImuMonitor& watch, const PlausibilityTick& tick, const ImuErrors& errors) {
  if (errors.held() == 0 || !errors.back(0).contradicted) return;
  watch.masked = std::max(watch.masked, lately_contradicted(errors) > 1 ? tick.looks(quarantine, 2) : 1);
}

}  // namespace

void advance(ImuMonitor& watch, const ImuMonitor::Past& past, const InertialMonitor& learned,
             const AngleMonitor& angles, const PlausibilityTick& tick, Plausibility& found) noexcept {
  take_motion(watch, tick);
  const TickMotions motions(watch.motion, past.motion, tick);
  const ImuErrors errors(watch.errors, past.errors);
  const ImuReading& reading = tick.imu;
  const bool usable_now =
      reading.valid && usable(reading.angular_velocity, 3) && usable(reading.specific_force, 3);
  count_missing(watch, tick, usable_now);
  watch.masked = std::max(watch.masked - 1, 0);
  if (usable_now && reading.acquired > watch.before.acquired && learned.gyroscope.known()) {
    ImuFault doubt = repetition(watch, learned, reading);
    if (reading.acquired - watch.before.acquired > 3 * tick.period / 2 + tick.limits.stamp_spread)
      watch.errors.clear();
    const ImuSpread rest{learned.accelerometer.deviation, learned.gyroscope.deviation};
    judge(watch, motions, errors, learned, angles, tick, reading, rest);
    mask(watch, tick, errors);
    if (doubt == ImuFault::none && jumps(errors)) doubt = ImuFault::noisy;
    if (doubt == ImuFault::none && errors.contradicted(tick.looks(judged)) >= tick.looks(judged / 2, 2))
      doubt = watch.late ? ImuFault::late
                         : explanation(errors, {std::max(rest.force, 0.2), std::max(rest.turning, 5e-3)});
    if (doubt == ImuFault::none && watch.late && lately_contradicted(errors) < 2) doubt = ImuFault::late;
    forgive(watch, tick, errors, doubt);
    if (watch.doubt == ImuFault::none) watch.doubt = doubt;
  }
  if (usable_now) watch.before = reading;
  found.imu_doubt = watch.doubt;
  found.imu_left_out = watch.doubt != ImuFault::none || watch.masked > 0;
}

}  // namespace flinch
