#include "systems/estimators/imu_filter.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "systems/estimators/innovation_mean.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/signals/stamp_spread.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const ImuFilterSettings& settings) {
  const ImuFilterNoise& noise = settings.noise;
  Findings found;
  found.positive("noise.encoder_pose.translation", noise.encoder_pose.translation, "m^2");
  found.positive("noise.encoder_pose.rotation", noise.encoder_pose.rotation, "rad^2");
  found.positive("noise.gyroscope", noise.gyroscope, "rad^2/s^2");
  found.positive("noise.accelerometer", noise.accelerometer, "m^2/s^4");
  found.positive("noise.acceleration.translation", noise.acceleration.translation, "m^2/s^4");
  found.positive("noise.acceleration.rotation", noise.acceleration.rotation, "rad^2/s^4");
  found.positive("largest_innovation", settings.largest_innovation);
  found.finite("mount.position_in_platform", settings.mount.position_in_platform, "m");
  found.finite("mount.angles", settings.mount.angles, "rad");
  return found.take();
}

}  // namespace

ImuFilterSettings published_imu_filter() {
  return {.mount = {},
          .stamp_spread = {},
          .noise = {.encoder_pose = {1.2e-1, 1.2e-1},
                    .gyroscope = 1.6e-3,
                    .accelerometer = 7e-2,
                    .pose = {1e-2, 1e-2},
                    .velocity = {1e1, 1e1},
                    .acceleration = {1e5, 1e5},
                    .gyroscope_bias = 0.0,
                    .accelerometer_bias = 0.0},
          .initial_pose = {0.1, 0.1},
          .initial_velocity = {0.1, 0.1},
          .initial_acceleration = {0.1, 0.1},
          .sampling = {}};
}

ImuFilterSettings extended_imu_filter() {
  return {.mount = {},
          .stamp_spread = {},
          .noise = {.encoder_pose = {1e-9, 1e-8},
                    .gyroscope = 7.5e-6,
                    .accelerometer = 1.56e-3,
                    .pose = {1e-14, 1e-14},
                    .velocity = {1e-8, 1e-8},
                    .acceleration = {1.0, 30.0},
                    .gyroscope_bias = 1e-12,
                    .accelerometer_bias = 1e-10},
          .initial_pose = {1e-6, 1e-6},
          .initial_velocity = {0.1, 0.1},
          .initial_acceleration = {1.0, 10.0},
          .initial_gyroscope_bias = 0.01,
          .initial_accelerometer_bias = 0.25,
          .estimates_biases = true,
          .aligned = true,
          .largest_innovation = 10.0,
          .settling_time = 200ms,
          .sampling = {}};
}

ImuFilterSettings unscented_imu_filter() {
  ImuFilterSettings settings = extended_imu_filter();
  settings.unscented = true;
  return settings;
}

ImuFilter::ImuFilter(std::shared_ptr<const ParallelRobot> robot, const ImuFilterSettings& settings)
    : settings_(settings),
      robot_(std::move(robot)),
      imu_(settings.mount),
      n_(robot_->dof()),
      states_(3 * n_ + (settings.estimates_biases ? 6 : 0)) {
  throw_if_any(problems(settings));
  keep(Every{settings_.sampling.period}, memory_, next_);
}

void ImuFilter::advance(const PlatformMotion& motion, const ImuReading& reading,
                        const History<PoseSample, late_samples>& poses, const ImuFilterMemory& memory,
                        Time now, ImuFilterMemory& next) const {
  const bool sees_imu = is_usable(reading);
  const PoseSample pose =
      sees_imu && reading.acquired > memory.measured ? pose_for(reading, motion, poses) : PoseSample();
  const bool has_pose = pose.pose.size() == robot_->space().stored();
  if (!has_pose || (memory.started && pose.acquired <= memory.time)) {
    next = waiting(memory, now);
    next.sees_imu = sees_imu;
    return;
  }
  if (!memory.started || settings_.sampling.interrupted(memory.time, pose.acquired)) {
    begin(pose, motion, now, next);
  } else {
    next = memory;
    const double T = to_seconds(pose.acquired - memory.time);
    predict(T, next);
    correct(pose, reading, T, next);
  }
  next.measured = reading.acquired;
  next.force = reading.specific_force;
  next.time = pose.acquired;
  next.arrived = now;
  next.sees_imu = true;
  const bool is_finite = next.pose.allFinite() && next.velocity.allFinite() &&
                         next.acceleration.allFinite() && next.errors.P.allFinite();
  if (!is_finite) next = ImuFilterMemory();
}

/// For a reading that is new: as long as the last one may be held, and then for a new beginning.
ImuFilterMemory ImuFilter::waiting(const ImuFilterMemory& memory, Time now) const {
  if (!memory.started || !settings_.sampling.expired(memory.arrived, now)) return memory;
  ImuFilterMemory fresh;
  fresh.measured = memory.measured;
  return fresh;
}

bool ImuFilter::is_usable(const ImuReading& reading) const {
  return reading.valid && usable(reading.angular_velocity, 3) && usable(reading.specific_force, 3);
}

/// Aligned, that of the time at which the IMU measured, between two samples; else the newest. Empty where
/// there is none.
PoseSample ImuFilter::pose_for(const ImuReading& reading, const PlatformMotion& motion,
                               const History<PoseSample, late_samples>& poses) const {
  const PoseSample newest{motion.acquired, motion.pose};
  if (!motion.valid()) return {};
  if (!settings_.aligned || reading.acquired == motion.acquired) return newest;
  const PoseSample* const before = poses.last_before(reading.acquired);
  const PoseSample* after = poses.first_from(reading.acquired);
  if (after == nullptr && motion.acquired >= reading.acquired) after = &newest;
  if (before == nullptr || after == nullptr) return {};
  if (settings_.sampling.interrupted(before->acquired, after->acquired)) return {};
  const double share =
      to_seconds(reading.acquired - before->acquired) / to_seconds(after->acquired - before->acquired);
  const PlatformVector way = robot_->difference(after->pose, before->pose);
  return {reading.acquired, robot_->space().plus(before->pose, share * way)};
}

void ImuFilter::remember(const PlatformMotion& motion, History<PoseSample, late_samples>& poses) const {
  if (motion.valid()) poses.push({motion.acquired, motion.pose});
}

void ImuFilter::begin(const PoseSample& pose, const PlatformMotion& motion, Time now,
                      ImuFilterMemory& next) const {
  next = ImuFilterMemory();
  next.started = true;
  next.since = now;
  next.pose = pose.pose;
  next.velocity = motion.velocity;
  next.acceleration.setZero(n_);
  next.errors.P.setZero(states_, states_);
  for (int i = 0; i < n_; ++i) {
    next.errors.P(i, i) = of(settings_.initial_pose, i);
    next.errors.P(n_ + i, n_ + i) = of(settings_.initial_velocity, i);
    next.errors.P(2 * n_ + i, 2 * n_ + i) = of(settings_.initial_acceleration, i);
  }
  next.bias.valid = settings_.estimates_biases;
  if (!settings_.estimates_biases) return;
  next.errors.P.diagonal().segment(3 * n_, 3).setConstant(settings_.initial_gyroscope_bias);
  next.errors.P.diagonal().segment(3 * n_ + 3, 3).setConstant(settings_.initial_accelerometer_bias);
}

/// X- = A X, P- = A P A^T + Q with A = [I, T I, T^2/2 I; 0, I, T I; 0, 0, I]. [RAL25] (6)
void ImuFilter::predict(double T, ImuFilterMemory& next) const {
  const double half = 0.5 * T * T;
  next.pose = robot_->space().plus(next.pose, T * next.velocity + half * next.acceleration);
  next.velocity += T * next.acceleration;

  auto& P = next.errors.P;
  P.topRows(n_) += T * P.middleRows(n_, n_) + half * P.middleRows(2 * n_, n_);
  P.middleRows(n_, n_) += T * P.middleRows(2 * n_, n_);
  P.leftCols(n_) += T * P.middleCols(n_, n_) + half * P.middleCols(2 * n_, n_);
  P.middleCols(n_, n_) += T * P.middleCols(2 * n_, n_);

  const double periods = T / 1e-3;  // for which the noise is given
  const ImuFilterNoise& Q = settings_.noise;
  for (int i = 0; i < n_; ++i) {
    P(i, i) += periods * of(Q.pose, i);
    P(n_ + i, n_ + i) += periods * of(Q.velocity, i);
    P(2 * n_ + i, 2 * n_ + i) += periods * of(Q.acceleration, i);
  }
  if (!settings_.estimates_biases) return;
  P.diagonal().segment(3 * n_, 3).array() += periods * Q.gyroscope_bias;
  P.diagonal().segment(3 * n_ + 3, 3).array() += periods * Q.accelerometer_bias;
}

/// Variances of specific force and rate that stamps make which err: by the slopes of both.
TwoKinds ImuFilter::by_stamps(const ImuOutput& expected, const ImuReading& reading, double T,
                              const ImuFilterMemory& states) const {
  if (settings_.stamp_spread == Time{}) return {};
  const double late = uniform_deviation(settings_.stamp_spread);
  const double force = late / T * (reading.specific_force - states.force).norm();
  const double rate = late * (expected.by_velocity.topRows<3>() * states.acceleration).norm();
  return {force * force, rate * rate};
}

void ImuFilter::correct(const PoseSample& pose, const ImuReading& reading, double T,
                        ImuFilterMemory& next) const {
  const ImuOutput expected = output_at(next);
  ImuPrediction imu{expected.value, output_matrix(expected), Eigen::Matrix<double, 6, 1>::Zero()};
  if (settings_.unscented) spread_out(next, imu);
  Eigen::Matrix<double, 6, 1> imu_error;
  imu_error << reading.angular_velocity - next.bias.gyroscope,
      reading.specific_force - next.bias.accelerometer;
  imu_error -= imu.value;
  const PlatformVector pose_error = robot_->difference(pose.pose, next.pose);

  const TwoKinds stamps = by_stamps(expected, reading, T, next);
  next.errors.correction.setZero(states_);
  double squares = 0.0;
  const int outputs = n_ + 6;
  for (int i = 0; i < outputs; ++i) {
    const bool is_gyroscope = i < n_ + 3;
    double R = i < n_ ? of(settings_.noise.encoder_pose, i)
                      : (is_gyroscope ? settings_.noise.gyroscope + stamps.rotation
                                      : settings_.noise.accelerometer + stamps.translation);
    if (i >= n_) R += imu.bending[i - n_];
    const double innovation = i < n_ ? pose_error[i] : imu_error[i - n_];
    squares += next.errors.measure(imu.C.row(i).transpose(), R, innovation);
  }
  next.errors.P = 0.5 * (next.errors.P + next.errors.P.transpose()).eval();
  add(next.errors.correction, next);
  next.innovation = innovation_mean(next.innovation, squares, outputs, T);
}

void ImuFilter::add(const Errors::Vector& change, ImuFilterMemory& states) const {
  states.pose = robot_->space().plus(states.pose, change.head(n_));
  states.velocity += change.segment(n_, n_);
  states.acceleration += change.segment(2 * n_, n_);
  if (!settings_.estimates_biases) return;
  states.bias.gyroscope += change.segment<3>(3 * n_);
  states.bias.accelerometer += change.segment<3>(3 * n_ + 3);
}

/// At the points X +- sqrt(N) l_i, P = L L^T: with y+-_i there, D = (y+_i - y-_i) / (2 sqrt(N)) is C L, and
/// what the y spread beyond D D^T bends. Points of a spherical cubature: Arasaratnam and Haykin, IEEE
/// Transactions on Automatic Control 54, 2009. Leaves what is there where P has no root.
void ImuFilter::spread_out(const ImuFilterMemory& states, ImuPrediction& prediction) const {
  const int sources = 3 * n_;  // biases add to the output as they are
  Errors::Matrix root = states.errors.P.topLeftCorner(sources, sources);
  if (Eigen::LLT<Eigen::Ref<Errors::Matrix>>(root).info() != Eigen::Success) return;
  root.triangularView<Eigen::StrictlyUpper>().setZero();
  const double away = std::sqrt(static_cast<double>(sources));
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 2 * ImuFilterMemory::states> seen(6, 2 * sources);
  ImuFilterMemory point;
  Errors::Vector change = Errors::Vector::Zero(states_);
  for (int i = 0; i < 2 * sources; ++i) {
    change.head(sources) = (i < sources ? away : -away) * root.col(i % sources);
    point.pose = states.pose;
    point.velocity = states.velocity;
    point.acceleration = states.acceleration;
    add(change, point);
    seen.col(i) = output_at(point).value;
  }
  prediction.value = seen.rowwise().mean();
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, ImuFilterMemory::states> D =
      (seen.leftCols(sources) - seen.rightCols(sources)) / (2.0 * away);
  const Eigen::Matrix<double, 6, 1> spread =
      (seen.colwise() - prediction.value).rowwise().squaredNorm() / (2.0 * sources);
  prediction.bending = (spread - D.rowwise().squaredNorm()).cwiseMax(0.0);
  root.triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(D);
  prediction.C.block(n_, 0, 6, sources) = D;
}

/// How all that is measured changes with the states: pose, angular velocity, specific force. [RAL25] (7)
ImuFilter::Rows ImuFilter::output_matrix(const ImuOutput& sensed) const {
  Rows C;
  C.setZero(n_ + 6, states_);
  C.topLeftCorner(n_, n_).setIdentity();
  C.block(n_, 0, 6, n_) = sensed.by_pose;
  C.block(n_, n_, 6, n_) = sensed.by_velocity;
  C.block(n_, 2 * n_, 6, n_) = sensed.by_acceleration;
  if (settings_.estimates_biases) C.bottomRightCorner<6, 6>().setIdentity();
  return C;
}

ImuOutput ImuFilter::output_at(const ImuFilterMemory& states) const {
  return imu_output(robot_->space(), imu_, robot_->gravity(), states.pose, states.velocity,
                    states.acceleration);
}

/// O = [C; C A; C A^2], every row counted by its noise and every column scaled to length one.
double ImuFilter::observe(const ImuFilterMemory& next) const {
  if (!next.started) return 0.0;
  Rows C = output_matrix(output_at(next));
  for (int i = 0; i < n_; ++i) C.row(i) /= std::sqrt(of(settings_.noise.encoder_pose, i));
  C.middleRows(n_, 3) /= std::sqrt(settings_.noise.gyroscope);
  C.bottomRows(3) /= std::sqrt(settings_.noise.accelerometer);

  const double T = to_seconds(settings_.sampling.period);
  Errors::Matrix gramian = C.transpose().lazyProduct(C);
  for (int step = 1; step <= 2; ++step) {  // C A^step
    C.middleCols(2 * n_, n_) += T * C.middleCols(n_, n_) + 0.5 * T * T * C.leftCols(n_);
    C.middleCols(n_, n_) += T * C.leftCols(n_);
    gramian += C.transpose().lazyProduct(C);
  }
  const Errors::Vector lengths = gramian.diagonal().cwiseSqrt();
  if (!(lengths.minCoeff() > 0.0) || !lengths.allFinite()) return 0.0;
  for (int i = 0; i < states_; ++i) {
    gramian.row(i) /= lengths[i];
    gramian.col(i) /= lengths[i];
  }
  const Eigen::SelfAdjointEigenSolver<Errors::Matrix> solver(gramian, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues()[0], most = solver.eigenvalues()[states_ - 1];
  return least > 0.0 ? std::sqrt(least / most) : 0.0;
}

void ImuFilter::read(const ImuFilterMemory& next, double observable, Time now,
                     PlatformAcceleration& result) const {
  result = PlatformAcceleration();
  result.acquired = next.time;
  const bool is_settled = next.started && now - next.since >= settings_.settling_time;
  result.valid = is_settled && next.sees_imu && next.innovation <= settings_.largest_innovation;
  result.acceleration = next.started ? next.acceleration : PlatformVector::Zero(n_);
  result.health = {.fallen_back = false, .innovation = next.innovation, .observability = observable};
  if (!next.started) return;
  result.standard_deviation = next.errors.P.diagonal().segment(2 * n_, n_).cwiseMax(0.0).cwiseSqrt();
}

}  // namespace flinch
