#include "systems/estimators/momentum_kalman_filter.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "systems/estimators/chain_observability.h"
#include "systems/estimators/innovation_mean.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double settling_time_constants = 5.0;
const Eigen::RowVector2d C(1.0, 0.0);

Eigen::Matrix2d transition(double T) { return (Eigen::Matrix2d() << 1.0, T, 0.0, 1.0).finished(); }

/// Of white noise with the densities of `noise`, integrated exactly over T.
Eigen::Matrix2d process_noise(const MomentumNoise& noise, double T) {
  const double Q_p = noise.momentum_density, Q_f = noise.force_density;
  Eigen::Matrix2d Q;
  Q << Q_p * T + Q_f * T * T * T / 3.0, Q_f * T * T / 2.0, Q_f * T * T / 2.0, Q_f * T;
  return Q;
}

Eigen::Matrix2d predicted(const Eigen::Matrix2d& P, const MomentumNoise& noise, double T) {
  const Eigen::Matrix2d A = transition(T);
  return A * P * A.transpose() + process_noise(noise, T);
}

double measurement_noise(const MomentumNoise& noise) {
  return noise.momentum_deviation * noise.momentum_deviation;
}

Eigen::Vector2d gain(const Eigen::Matrix2d& predicted_covariance, double R) {
  return predicted_covariance.col(0) / (predicted_covariance(0, 0) + R);
}

/// Joseph's form: symmetric and positive whatever the rounding.
Eigen::Matrix2d updated(const Eigen::Matrix2d& P, const Eigen::Vector2d& K, double R) {
  const Eigen::Matrix2d rest = Eigen::Matrix2d::Identity() - K * C;
  return rest * P * rest.transpose() + R * K * K.transpose();
}

/// The covariance that updates at every period lead to.
Eigen::Matrix2d steady_covariance(const MomentumNoise& noise, double T) {
  const double R = measurement_noise(noise);
  Eigen::Matrix2d P = R * Eigen::Matrix2d::Identity();
  for (int k = 0; k < 1'000'000; ++k) {
    const Eigen::Matrix2d before = P;
    P = predicted(P, noise, T);
    P = updated(P, gain(P, R), R);
    if (((P - before).array().abs() <= 1e-13 * P.array().abs()).all()) break;
  }
  return P;
}

/// Time constant of the slowest error in steady state [s].
double slowest_time_constant(const MomentumNoise& noise, const Eigen::Matrix2d& steady, double T) {
  const Eigen::Vector2d K = gain(predicted(steady, noise, T), measurement_noise(noise));
  const Eigen::Matrix2d errors = (Eigen::Matrix2d::Identity() - K * C) * transition(T);
  const double radius = errors.eigenvalues().cwiseAbs().maxCoeff();
  return T / -std::log(radius);
}

std::vector<std::string> problems(const MomentumNoise& noise, const std::string& of) {
  Findings found(of);
  found.positive("momentum_deviation", noise.momentum_deviation);
  found.positive("force_density", noise.force_density);
  found.not_negative("momentum_density", noise.momentum_density);
  return found.take();
}

const MomentumKalmanFilterSettings& checked(const MomentumKalmanFilterSettings& settings) {
  Findings found;
  found.add_all(problems(settings.translation, "translation."));
  found.add_all(problems(settings.rotation, "rotation."));
  throw_if_any(found.take());
  return settings;
}

}  // namespace

MomentumKalmanMethod::MomentumKalmanMethod(int translations, int rotations,
                                           const MomentumKalmanFilterSettings& settings)
    : translations_(translations),
      noise_{settings.translation, settings.rotation},
      observability_(chain_observability<2>()) {
  const double T = to_seconds(settings.inputs.sampling.period);
  double slowest = 0.0;
  for (std::size_t kind = 0; kind < noise_.size(); ++kind) {
    steady_covariance_[kind] = steady_covariance(noise_[kind], T);
    const int coordinates = kind == 0 ? translations : rotations;
    if (coordinates == 0) continue;
    slowest = std::max(slowest, slowest_time_constant(noise_[kind], steady_covariance_[kind], T));
  }
  settling_time_ = from_seconds(settling_time_constants * slowest);
}

MomentumKalmanMethod::Memory MomentumKalmanMethod::begin(const PlatformVector& p) const {
  Memory memory;
  memory.momentum = p;
  memory.wrench.setZero(p.size());
  for (int i = 0; i < max_dof; ++i) {
    memory.covariance[static_cast<std::size_t>(i)] = steady_covariance_[i < translations_ ? 0 : 1];
  }
  return memory;
}

void MomentumKalmanMethod::advance(const Memory& memory, const MomentumStep& step, Memory& next) const {
  next.momentum = memory.momentum + step.T * (memory.wrench + step.known);
  next.wrench = memory.wrench;
  double square = 0.0;
  const int coordinates = static_cast<int>(step.end.size());
  for (int i = 0; i < coordinates; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double R = measurement_noise(noise(i));
    const Eigen::Matrix2d P = predicted(memory.covariance[at], noise(i), step.T);
    const Eigen::Vector2d K = gain(P, R);
    const double innovation = step.end[i] - next.momentum[i];
    next.momentum[i] += K[0] * innovation;
    next.wrench[i] += K[1] * innovation;
    next.covariance[at] = updated(P, K, R);
    square += innovation * innovation / (P(0, 0) + R);
  }
  next.innovation = innovation_mean(memory.innovation, square, coordinates, step.T);
}

void MomentumKalmanMethod::describe(const Memory& memory, WrenchEstimate& estimate) const {
  estimate.standard_deviation.resize(memory.wrench.size());
  for (int i = 0; i < static_cast<int>(memory.wrench.size()); ++i) {
    estimate.standard_deviation[i] = std::sqrt(memory.covariance[static_cast<std::size_t>(i)](1, 1));
  }
  estimate.health.innovation = memory.innovation;
  estimate.health.observability = observability_;
}

MomentumKalmanFilter::MomentumKalmanFilter(const std::shared_ptr<const ParallelRobot>& robot,
                                           const MomentumKalmanFilterSettings& settings)
    : MomentumEstimator(
          robot,
          MomentumKalmanMethod(robot->space().translations(), robot->space().rotations(), checked(settings)),
          settings.inputs) {}

}  // namespace flinch
