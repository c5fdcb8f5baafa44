#include "tests/identification/coverage.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include "identification/dynamics_fit.h"
#include "identification/imu_pose_fit.h"
#include "identification/torque_constant_fit.h"
#include "identification/zero_phase.h"
#include "systems/framework/random.h"
#include "systems/robot/parameter_variants.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/rotation.h"
#include "tests/identification/synthetic_pulls.h"

namespace flinch::test {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

/// P(X <= k) of a binomial distribution.
double binomial_at_most(int k, int n, double p) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) + i * std::log(p) +
                    (n - i) * std::log1p(-p));
  }
  return sum;
}

/// Waves of one coordinate and their derivatives.
class RandomWaves {
 public:
  RandomWaves(double amplitude, double slowest, double fastest, RandomGenerator& random) {
    for (int i = 0; i < 4; ++i) {
      waves_.push_back({amplitude / 4.0, turn * random.uniform(slowest, fastest), random.uniform(0.0, turn)});
    }
  }
  /// The derivative of this order.
  double at(double time, int order) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) {
      sum += wave.amplitude * std::pow(wave.rate, order) *
             std::sin(wave.rate * time + wave.phase + 0.25 * turn * order);
    }
    return sum;
  }

 private:
  struct Wave {
    double amplitude, rate, phase;
  };
  std::vector<Wave> waves_;
};

Eigen::MatrixXd filtered_noise(Eigen::Index rows, double deviation, double period, RandomGenerator& random) {
  Eigen::MatrixXd noise(rows, 3);
  for (double& value : noise.reshaped()) value = deviation * random.normal();
  return zero_phase(noise, 40.0, period);
}

/// What an IMU of this pose says in a random motion in the plane.
ImuStretch random_stretch(const ImuPose& truth, RandomGenerator& random) {
  constexpr double period = 1e-3;
  constexpr Eigen::Index n = 4400;
  const RandomWaves x(0.15, 0.5, 1.8, random), y(0.15, 0.5, 1.8, random), angle(0.5, 0.5, 1.8, random);
  ImuStretch stretch;
  stretch.period = period;
  stretch.usable.assign(n, 1);
  // [RAL25] IV-A: densities of 0.007 degrees/s and 180e-6 g
  stretch.gyroscope = filtered_noise(n, 2.7e-3, period, random);
  stretch.accelerometer = filtered_noise(n, 0.04, period, random);
  stretch.angular_velocity.setZero(n, 3);
  stretch.angular_acceleration.setZero(n, 3);
  stretch.specific_force.setZero(n, 3);
  const auto motion = [&](double time, Eigen::Vector3d& w, Eigen::Vector3d& dw, Eigen::Vector3d& f) {
    const double c = std::cos(angle.at(time, 0)), s = std::sin(angle.at(time, 0));
    const double ax = x.at(time, 2), ay = y.at(time, 2);
    w << 0.0, 0.0, angle.at(time, 1);
    dw << 0.0, 0.0, angle.at(time, 2);
    f << c * ax + s * ay, -s * ax + c * ay, 9.81;
  };
  const Eigen::Matrix3d R_SE = truth.R_ES.conjugate().toRotationMatrix();
  for (Eigen::Index k = 0; k < n; ++k) {
    const double time = static_cast<double>(k) * period;
    Eigen::Vector3d w, dw, f;
    motion(time, w, dw, f);
    stretch.angular_velocity.row(k) = w.transpose();
    stretch.angular_acceleration.row(k) = dw.transpose();
    stretch.specific_force.row(k) = f.transpose();
    motion(time - truth.delay, w, dw, f);
    const Eigen::Vector3d force = f + dw.cross(truth.position) + w.cross(w.cross(truth.position));
    stretch.gyroscope.row(k) += (R_SE * w + truth.gyroscope_bias).transpose();
    stretch.accelerometer.row(k) += (R_SE * force + truth.accelerometer_bias).transpose();
  }
  return stretch;
}

Eigen::Vector3d random_vector(double size, RandomGenerator& random) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Rows of a random motion whose torques are those of a robot with `surplus` beyond what is believed.
DynamicsRows random_rows(const PlanarRrr& robot, const DynamicParameters& parameters,
                         const Eigen::VectorXd& surplus, RandomGenerator& random) {
  const ParameterVariants variants(parameters);
  const std::vector<RandomWaves> waves = {RandomWaves(0.35, 0.3, 1.5, random),
                                          RandomWaves(0.35, 0.3, 1.5, random),
                                          RandomWaves(0.7, 0.3, 1.5, random)};
  JointVector cogging(3), phase(3);
  for (int i = 0; i < 3; ++i) cogging[i] = random.uniform(0.0, 0.5), phase[i] = random.uniform(0.0, turn);
  constexpr int samples = 1000;
  DynamicsRows rows;
  rows.regressor.resize(3 * samples, surplus.size());
  rows.surplus.resize(3 * samples);
  for (int k = 0; k < samples; ++k) {
    const double time = 0.02 * k;
    Configuration pose = robot.home_pose();
    PlatformVector velocity(3), acceleration(3);
    for (int c = 0; c < 3; ++c) {
      const RandomWaves& wave = waves[static_cast<std::size_t>(c)];
      pose[c] += wave.at(time, 0), velocity[c] = wave.at(time, 1), acceleration[c] = wave.at(time, 2);
    }
    Kinematics at;
    robot.kinematics(pose, velocity, at);
    const Eigen::MatrixXd Y = variants.regressor(model_effort(robot, at, acceleration), at, acceleration);
    for (int i = 0; i < 3; ++i) {
      const int row = 3 * k + i;
      rows.regressor.row(row) = Y.row(i);
      rows.surplus[row] = Y.row(i).dot(surplus) +
                          cogging[i] * std::sin(24.0 * at.joints.active[i] + phase[i]) +
                          0.05 * random.normal();
      rows.drive.push_back(i);
      rows.cluster.push_back(static_cast<int>(time / 0.5));
      rows.recording.push_back(0);
      rows.time.push_back(time);
    }
  }
  rows.torque = rows.surplus;
  return rows;
}

}  // namespace

void Coverage::count(const std::string& parameter, double error, double deviation) {
  Count& count = of_parameter_[parameter];
  count.covered += std::abs(error) <= 1.96 * deviation ? 1 : 0;
  ++count.all;
  const double in_deviations = error / deviation;
  count.sum += in_deviations;
  count.squares += in_deviations * in_deviations;
}

void Coverage::print() const {
  std::printf("  %-28s %12s %12s %10s\n", "error in deviations of", "mean", "deviation", "covered");
  for (const auto& [name, count] : of_parameter_) {
    const double mean = count.sum / count.all;
    const double variance = count.squares / count.all - mean * mean;
    std::printf("  %-28s %12.2f %12.2f %8.1f %%\n", name.c_str(), mean, std::sqrt(variance),
                100.0 * count.covered / count.all);
  }
}

int Coverage::covered() const {
  int sum = 0;
  for (const auto& [name, count] : of_parameter_) sum += count.covered;
  return sum;
}

int Coverage::intervals() const {
  int sum = 0;
  for (const auto& [name, count] : of_parameter_) sum += count.all;
  return sum;
}

double Coverage::scatter() const {
  double squares = 0.0;
  for (const auto& [name, count] : of_parameter_) squares += count.squares;
  return std::sqrt(squares / intervals());
}

double Coverage::share() const { return static_cast<double>(covered()) / intervals(); }

double Coverage::probability() const {
  double least = 1.0;
  for (const auto& [name, count] : of_parameter_)
    least = std::min(least, binomial_at_most(count.covered, count.all, 0.95));
  return least;
}

Coverage cover_torque_constants(int calibrations, std::uint64_t first_seed) {
  const SyntheticPulls truth{
      .misalignment = 0.035, .current_noise = 0.003, .torque_noise = 0.05, .cogging = 0.5, .windows = 15};
  Coverage coverage;
  for (int trial = 0; trial < calibrations; ++trial) {
    const auto windows = make(truth, first_seed + static_cast<std::uint64_t>(trial));
    const TorqueConstantFit fit = fit_torque_constants(windows, 7, Eigen::Vector3d::Constant(6.1), {});
    const Eigen::VectorXd deviation = fit_uncertainty(fit.linear).deviation;
    for (int i = 0; i < 3; ++i) {
      coverage.count("drive " + std::to_string(i + 1), fit.constant[i] - truth.constant[i],
                     deviation[fit.column_of_drive[static_cast<std::size_t>(i)]]);
    }
  }
  return coverage;
}

Coverage cover_imu_poses(int calibrations, std::uint64_t first_seed) {
  Coverage coverage;
  for (int trial = 0; trial < calibrations; ++trial) {
    RandomGenerator random(first_seed + static_cast<std::uint64_t>(trial));
    ImuPose truth;
    truth.R_ES = turned(truth.R_ES, random_vector(0.1, random));
    truth.position = random_vector(0.08, random);
    truth.gyroscope_bias = random_vector(0.05, random);
    truth.accelerometer_bias = random_vector(0.39, random);
    truth.delay = random.uniform(2e-3, 5e-3);
    const ImuPoseFit fit = fit_imu_pose({random_stretch(truth, random)}, {});
    const FitUncertainty sure = fit_uncertainty(fit.linear);
    Eigen::VectorXd error(13);
    const Eigen::AngleAxisd rotation(truth.R_ES * fit.pose.R_ES.conjugate());
    error << rotation.angle() * rotation.axis(), truth.position - fit.pose.position,
        truth.gyroscope_bias - fit.pose.gyroscope_bias,
        truth.accelerometer_bias - fit.pose.accelerometer_bias, truth.delay - fit.pose.delay;
    for (Eigen::Index i = 0; i < 13; ++i) {
      if (sure.identifiable[static_cast<std::size_t>(i)])
        coverage.count("column " + std::to_string(i), error[i], sure.deviation[i]);
    }
  }
  return coverage;
}

namespace {

/// By how much a parameter of a robot is off from what is believed of it.
double drawn_surplus(const DynamicParameter& parameter, RobotsDrawn drawn, RandomGenerator& random) {
  if (drawn == RobotsDrawn::near_their_model) {
    const double size = parameter.name.find("friction") != std::string::npos ? 0.2 : 0.1;
    return parameter.believed * random.uniform(-size, size);
  }
  double surplus;
  do surplus = parameter.deviation * random.normal();
  while (parameter.believed + surplus < parameter.least);
  return surplus;
}

}  // namespace

Coverage cover_dynamics(int calibrations, std::uint64_t first_seed, RobotsDrawn drawn) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  const auto parameters = DynamicParameters::of(robot);
  const std::vector<DynamicParameter>& list = parameters->list();
  Coverage coverage;
  for (int trial = 0; trial < calibrations; ++trial) {
    RandomGenerator random(first_seed + static_cast<std::uint64_t>(trial));
    Eigen::VectorXd surplus(parameters->believed().size());
    for (std::size_t j = 0; j < list.size(); ++j)
      surplus[static_cast<Eigen::Index>(j)] = drawn_surplus(list[j], drawn, random);
    const DynamicsRows rows = random_rows(robot, *parameters, surplus, random);
    std::vector<bool> held(list.size(), false);
    DynamicsFit fit = fit_dynamics(rows, list, 3, 1.0, held);
    FitUncertainty sure = fit_uncertainty(fit.linear);
    for (std::size_t j = 0; j < list.size(); ++j) held[j] = !sure.identifiable[j];
    fit = fit_dynamics(rows, list, 3, 1.0, held);
    sure = fit_uncertainty(fit.linear);
    for (std::size_t j = 0; j < list.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      if (!held[j])
        coverage.count(list[j].name, fit.values[i] - parameters->believed()[i] - surplus[i],
                       sure.deviation[i]);
    }
  }
  return coverage;
}

}  // namespace flinch::test
