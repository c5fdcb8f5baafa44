// What it costs where currents and encoders are not of one time: all filters and delays of the pipeline act
// on both sides of the balance of momentum, and one millisecond that does not shows as a force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "tests/experiments/simulated/fed_control.h"
#include "tests/support/in_parallel.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// A square at 1.5 m/s, 12 m/s^2 and 1000 m/s^3, exactly measured, watched by one estimator.
SimulatedScenario square(const std::string& estimator) {
  const test::Workplace place;
  place.write("scenarios/square.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 1.6\nsensors: {ideal: true}\n"
              "motion:\n  kind: square\n  start_ms: 300\n"
              "  limits: {velocity_m_per_s: 1.5, acceleration_m_per_s2: 12, jerk_m_per_s3: 1000}\n"
              "control:\n  estimators: [" +
                  estimator + "]\n" +
                  "  momentum_observer: {gain_per_s: [135, 135, 135]}\n"
                  "  contact_detector: {reaction_force_N: 500, reaction_moment_Nm: 100, hard_force_N: 600, "
                  "hard_moment_Nm: 200}\n");
  return read_simulated_scenario(place / "scenarios/square.yaml");
}

/// Largest force that is estimated where the currents come `skew` ticks late [N].
double largest_force(const SimulatedScenario& scenario, const std::vector<test::Readings>& readings,
                     std::size_t skew) {
  test::FedControl control(scenario);
  double largest = 0.0;
  for (std::size_t k = skew; k < readings.size(); ++k) {
    test::Readings now = readings[k];
    now.drives.current = readings[k - skew].drives.current;
    const WrenchEstimate& estimate = control.see(now);
    if (k < 350 || !estimate.valid) continue;
    largest = std::max(largest, estimate.wrench_in_base.head(2).lpNorm<Eigen::Infinity>());
  }
  return largest;
}

class SkewedReadings : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, SkewedReadings,
                         testing::Values("momentum_observer", "disturbance_filter", "imu_residual"),
                         [](const auto& tested) { return tested.param; });

// 4.5 kg times 1000 m/s^3 times 1 ms are 4.5 N, less what the observer filters away.
TEST_P(SkewedReadings, LookLikeAForceOfSomeNewtonsForAMillisecond) {
  const SimulatedScenario scenario = square(GetParam());
  const std::vector<test::Readings> readings = test::readings_of(run_experiment(scenario));
  const double aligned = largest_force(scenario, readings, 0);
  const double skewed = largest_force(scenario, readings, 1);
  std::printf("%-20s aligned %5.2f N, currents 1 ms late %5.2f N\n", GetParam().c_str(), aligned, skewed);
  EXPECT_GT(skewed, aligned + 1.5);
  EXPECT_LT(skewed, aligned + 8.0);
}

/// Largest error of a robot's estimate in free motion, with samples of the IMU so long before each tick [N].
double largest_error(const std::string& file, std::uint64_t seed) {
  const SimulatedScenario scenario = read_simulated_scenario(file, seed);
  const Verdict verdict = judge(run_experiment(scenario), scenario.robot.robot->space(), scenario.expected,
                                scenario.force_limits);
  EXPECT_EQ(verdict.imu_doubt, ImuFault::none) << seed;
  return verdict.max_observer_error_force;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Seven tenths of a tick before it, torques that jump between a sample and a tick, as at corners of a square,
// make single robots err by up to 1.5 times as much: there the mean of eight is judged.
TEST(ImuBetweenTicks, IsBelievedAndLeavesAResidualAsSmallAsOnTheTick) {
  constexpr std::size_t robots = 8;
  const test::Workplace place;
  std::vector<double> on_tick;
  for (const int before : {0, 60, 300, 500, 700}) {
    place.write("scenarios/clock.yaml",
                "robot: ../robots/planar_3rrr.yaml\nduration_s: 1.6\nplant: {realism: bench}\n"
                "sensors: {imu: {before_tick_us: " +
                    std::to_string(before) + "}}\n" +
                    "motion:\n  kind: square\n  start_ms: 300\n"
                    "  limits: {velocity_m_per_s: 1.5, acceleration_m_per_s2: 12, jerk_m_per_s3: 1000}\n"
                    "control:\n  estimators: [imu_residual]\n"
                    "  momentum_observer: {gain_per_s: [135, 135, 135]}\n"
                    "  contact_detector: {reaction_force_N: 500, reaction_moment_Nm: 100, hard_force_N: 600, "
                    "hard_moment_Nm: 200}\n");
    const std::string file = place.at("scenarios/clock.yaml");
    const std::vector<double> errors = test::in_parallel(
        robots, [&file](std::size_t i) { return largest_error(file, i + 1); }, 2);
    if (before == 0) on_tick = errors;
    std::printf("%3d us before the tick: %5.2f N\n", before, mean_of(errors));
    EXPECT_LT(mean_of(errors), 1.2 * mean_of(on_tick)) << before;
    for (std::size_t i = 0; i < robots && before <= 500; ++i)
      EXPECT_LT(errors[i], 1.2 * on_tick[i]) << before << ", robot " << i + 1;
  }
}

}  // namespace
}  // namespace flinch
