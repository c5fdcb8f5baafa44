// The simulation of [RAL25] IV: how well a filter of IMU and encoders tells the platform's acceleration in a
// fast motion without contact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/plant_truth.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/imu_mount.h"
#include "systems/robot/quantity_units.h"
#include "systems/signals/imu_bias.h"
#include "systems/signals/platform_acceleration.h"
#include "systems/signals/platform_motion.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

constexpr std::size_t first = 400;  // the motion has begun

constexpr double g = 9.80665;                                            // [m/s^2]
const Eigen::Vector3d worst_bias = Eigen::Vector3d::Constant(0.04 * g);  // in every axis, [RAL25] IV-A

/// The square of the paper, 1.41 m/s and 12.44 m/s^2, with an IMU of this sort.
SimulatedScenario square(const std::string& imu) {
  const test::Workplace place;
  place.write("scenarios/square.yaml",
              "robot: ../robots/planar_3rrr_nominal.yaml\nduration_s: 2.4\n"
              "motion:\n  kind: square\n  start_ms: 300\n  side_mm: 300\n"
              "  limits: {velocity_m_per_s: 1.41, acceleration_m_per_s2: 10.5, jerk_m_per_s3: 600}\n"
              "control:\n  accelerations: [imu_ekf, extended_imu_ekf, unscented_imu_filter]\n"
              "sensors:\n  imu: {" +
                  imu + "}\n");
  return read_simulated_scenario(place / "scenarios/square.yaml");
}

/// The same, with an accelerometer that has all of that bias.
SimulatedScenario square_with_bias(const std::string& imu) {
  SimulatedScenario scenario = square(imu);
  scenario.station.imu.fixed_accelerometer_bias = worst_bias;
  return scenario;
}

Recording run(const SimulatedScenario& scenario) {
  const Experiment experiment = build_experiment(scenario);
  const auto ticks = static_cast<std::size_t>(scenario.duration / 1ms);
  Recorder recorder(*experiment.diagram,
                    {"truth", "imu", "motion", "acceleration", "acceleration_extended_imu_ekf",
                     "acceleration_unscented_imu_filter", "control/extended_imu_ekf/bias"},
                    ticks, quantity_units(*scenario.robot.robot));
  Simulator simulator(*experiment.diagram, std::make_unique<SundialsIntegrator>());
  simulator.record(recorder);
  Context context = experiment.diagram->make_context();
  for (std::size_t tick = 0; tick < ticks; ++tick) simulator.step(context);
  return recorder.recording({});
}

/// How well an estimate follows a reference, [RAL25] IV-A.
struct Fidelity {
  double nrmse = 0.0;  ///< error over the range of the reference
  double snr = 0.0;    ///< [dB]
};

Fidelity fidelity(const std::vector<double>& estimate, const std::vector<double>& reference) {
  double signal = 0.0, noise = 0.0;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    signal += reference[k] * reference[k];
    noise += std::pow(estimate[k] - reference[k], 2);
  }
  const auto [least, most] = std::minmax_element(reference.begin(), reference.end());
  return {std::sqrt(noise / static_cast<double>(reference.size())) / (*most - *least),
          10.0 * std::log10(signal / noise)};
}

/// Of what is recorded under `path`, against the truth of its own time.
Fidelity fidelity(const Recording& recording, const std::string& path, int coordinate) {
  const auto estimates = read<PlatformAcceleration>(recording, path);
  const std::vector<double> truth = recording.column("truth", "acceleration", coordinate);
  std::vector<double> estimate, reference;
  for (std::size_t k = first; k < recording.samples(); ++k) {
    EXPECT_TRUE(estimates[k].valid) << path << " " << k;
    estimate.push_back(estimates[k].acceleration[coordinate]);
    reference.push_back(truth[static_cast<std::size_t>(estimates[k].acquired / 1ms)]);
  }
  return fidelity(estimate, reference);
}

/// Of the pose, differentiated twice and low-passed at 20 Hz, once or after each differentiation.
Fidelity differentiated(const Recording& recording, int coordinate, int passes) {
  const auto motion = read<PlatformMotion>(recording, "motion");
  const std::vector<double> truth = recording.column("truth", "acceleration", coordinate);
  constexpr double T = 1e-3, w = 2.0 * std::numbers::pi * 20.0;
  std::vector<double> estimate, reference;
  std::vector<double> filtered(static_cast<std::size_t>(passes), 0.0);
  for (std::size_t k = first - 100; k < recording.samples(); ++k) {
    const auto x = [&](std::size_t i) { return motion[i].pose[coordinate]; };
    double signal = (x(k) - 2.0 * x(k - 1) + x(k - 2)) / (T * T);
    for (double& each : filtered) {
      each += (1.0 - std::exp(-w * T)) * (signal - each);
      signal = each;
    }
    if (k < first) continue;
    estimate.push_back(signal);
    reference.push_back(truth[k]);
  }
  return fidelity(estimate, reference);
}

void print(const char* what, const Fidelity& x, const Fidelity& y, const Fidelity& phi) {
  std::printf("%-44s NRMSE %.4f %.4f %.4f   SNR %5.1f %5.1f %5.1f dB\n", what, x.nrmse, y.nrmse, phi.nrmse,
              x.snr, y.snr, phi.snr);
}

void print(const char* what, const Recording& recording, const std::string& path) {
  print(what, fidelity(recording, path, 0), fidelity(recording, path, 1), fidelity(recording, path, 2));
}

TEST(PublishedAcceleration, IsFastAndHardAsInThePaper) {
  const Recording recording = run(square("delay_us: 0"));
  const auto truth = read<PlantTruth>(recording, "truth");
  double speed = 0.0, acceleration = 0.0;
  for (std::size_t k = first; k < recording.samples(); ++k) {
    speed = std::max(speed, truth[k].velocity.head(2).norm());
    acceleration = std::max(acceleration, truth[k].acceleration.head(2).norm());
  }
  EXPECT_NEAR(speed, 1.41, 0.1);
  EXPECT_NEAR(acceleration, 12.44, 0.5);  // the controller adds to what is planned
}

TEST(PublishedAcceleration, IsAsGoodAsPrintedFromTheFilterAsPrinted) {
  const Recording recording =
      run(square("delay_us: 0, accelerometer_bias_m_per_s2: 0, gyroscope_bias_deg_per_s: 0"));
  print("EKF as printed, noise", recording, "acceleration");
  for (const int passes : {1, 2})
    print(passes == 1 ? "differentiated twice, 20 Hz" : "differentiated twice, 20 Hz each time",
          differentiated(recording, 0, passes), differentiated(recording, 1, passes),
          differentiated(recording, 2, passes));
  for (const int coordinate : {0, 1}) {
    const Fidelity seen = fidelity(recording, "acceleration", coordinate);
    EXPECT_LT(seen.nrmse, 0.012);
    EXPECT_GE(seen.snr, 25.0);
    EXPECT_GT(differentiated(recording, coordinate, 1).nrmse, 4.0 * seen.nrmse);
    EXPECT_NEAR(differentiated(recording, coordinate, 2).snr, 8.0, 1.0);  // as printed
  }
  print("EKF as printed, noise and bias", run(square_with_bias("delay_us: 0")), "acceleration");
  print("EKF as printed, noise, bias and delay", run(square_with_bias("delay_us: 3500")), "acceleration");
}

TEST(PublishedAcceleration, IsAsGoodFromTheExtendedFilterInSpiteOfBiasAndDelay) {
  const Recording recording = run(square_with_bias("delay_us: 3500"));
  print("extended EKF, noise, bias and delay", recording, "acceleration_extended_imu_ekf");
  print("unscented, noise, bias and delay", recording, "acceleration_unscented_imu_filter");
  for (const char* const path : {"acceleration_extended_imu_ekf", "acceleration_unscented_imu_filter"}) {
    for (const int coordinate : {0, 1}) {
      const Fidelity seen = fidelity(recording, path, coordinate);
      EXPECT_LT(seen.nrmse, 0.012) << path;
      EXPECT_GE(seen.snr, 25.0) << path;
    }
  }
}

TEST(PublishedAcceleration, LeadsToTheBiasOfTheAccelerometer) {
  const SimulatedScenario scenario = square_with_bias("delay_us: 0");
  const Recording recording = run(scenario);
  const auto truth = read<PlantTruth>(recording, "truth");
  const auto imu = read<ImuReading>(recording, "imu");
  const Mechanism& robot = *scenario.robot.robot;
  Eigen::Vector3d bias(0.0, 0.0, 0.0);  // mean of what the readings have beside the truth
  for (std::size_t k = first; k < recording.samples(); ++k) {
    const SpatialMotion now =
        spatial_motion(robot.space(), truth[k].pose, truth[k].velocity, truth[k].acceleration);
    const Eigen::Vector3d ideal =
        platform_to_sensor({}) * specific_force(now, ImuMount{}.position_in_platform, robot.gravity());
    bias += (imu[k].specific_force - ideal) / static_cast<double>(recording.samples() - first);
  }
  EXPECT_LT((bias - worst_bias).lpNorm<Eigen::Infinity>(), 0.002) << "as the readings show it";
  const Recording late = run(square_with_bias("delay_us: 3500"));
  const auto estimated = read<ImuBias>(late, "control/extended_imu_ekf/bias");
  const Eigen::Vector3d error = estimated[recording.samples() - 1].accelerometer - bias;
  std::printf("bias of the accelerometer missed by %.4f %.4f %.4f m/s^2\n", error.x(), error.y(), error.z());
  EXPECT_LT(error.lpNorm<Eigen::Infinity>(), 0.01);
}

}  // namespace
}  // namespace flinch
