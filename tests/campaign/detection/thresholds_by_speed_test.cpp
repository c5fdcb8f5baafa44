// Would thresholds that grow with the speed of the drives be lower where that matters? Errors in motion
// without contact by the speed of the platform, and the thresholds of half a false alarm an hour that are the
// same at every speed and that grow with it. FLINCH_ROBOTS says of how many robots; docs/theory.md cites 9.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "calibration/contact_free_motion.h"
#include "calibration/threshold_calibration.h"
#include "diagrams/estimator_stages.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/recorded_estimate.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/drive_load.h"
#include "systems/signals/platform_motion.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr double growth = 0.1;  // share of a threshold for each rad/s of the fastest drive

/// What an estimator said at a sample without contact.
struct Error {
  double force = 0.0;  ///< largest component [N]
  double speed = 0.0;  ///< of the platform [m/s]
  double rate = 0.0;   ///< of the fastest drive [rad/s]
};

/// One sample after the other.
using OfRobot = std::vector<Error>;
/// By estimator, of each robot.
using Errors = std::map<std::string, std::vector<OfRobot>>;

/// `besides`: an estimator that runs beside those of the scenario; empty: none.
Errors errors_of(int robots, const std::string& besides = "") {
  Errors errors;
  for (int robot = 0; robot < robots; ++robot) {
    SimulatedScenario scenario = read_simulated_scenario(
        FLINCH_SOURCE_DIR "/apps/scenarios/random_motion.yaml", 101 + static_cast<std::uint64_t>(robot));
    for (const WrenchEstimator& stage : estimator_stages())
      if (stage.name == besides) scenario.control.stages.estimators.add(stage);
    const Recording recording = run_experiment(scenario);
    const auto loads = read<DriveLoad>(recording, "load_fused_detector");
    const auto motions = read<PlatformMotion>(recording, "motion");
    for (const auto& [estimator, path] : estimates_of(recording)) {
      const auto estimates = read<RecordedEstimate>(recording, path);
      OfRobot& of_robot = errors[estimator].emplace_back();
      for (std::size_t k = 0; k < estimates.size(); ++k) {
        const RecordedEstimate estimate = estimates[k];
        if (!estimate.valid || !loads[k].valid) continue;
        of_robot.push_back({.force = largest_component(estimate.wrench_in_base.head(2)),
                            .speed = motions[k].velocity.head(2).norm(),
                            .rate = largest_component(loads[k].rate)});
      }
    }
  }
  return errors;
}

/// What one sample in a thousand exceeds between two speeds [N]; NaN, and a failure, without any.
double force_exceeded(const std::vector<OfRobot>& robots, double slow, double fast) {
  std::vector<double> forces;
  for (const OfRobot& errors : robots)
    for (const Error& error : errors)
      if (error.speed >= slow && error.speed < fast) forces.push_back(error.force);
  EXPECT_FALSE(forces.empty()) << "no robot moves at " << slow << " to " << fast << " m/s";
  if (forces.empty()) return std::nan("");
  const auto place = forces.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(forces.size()));
  std::nth_element(forces.begin(), place, forces.end());
  return *place;
}

/// The threshold of half a false alarm an hour for a robot at rest, if it grows by this share for each rad/s
/// of the fastest drive [N].
double threshold_at_rest(const std::vector<OfRobot>& robots, double share_of_rate) {
  const ThresholdGoal goal;
  const auto stretch = static_cast<std::size_t>(goal.stretch / 1ms);
  std::vector<double> peaks;
  for (const OfRobot& errors : robots) {
    for (std::size_t first = 0; first + stretch <= errors.size(); first += stretch) {
      double peak = 0.0;
      for (std::size_t k = first; k < first + stretch; ++k)
        peak = std::max(peak, errors[k].force / (1.0 + share_of_rate * errors[k].rate));
      peaks.push_back(peak);
    }
  }
  const double alarms_a_stretch = goal.false_alarms_per_hour / 3600.0 * to_seconds(goal.stretch);
  constexpr double share_of_force = 0.5;  // the moment may make the other half of the alarms
  return calibrated_threshold(peaks, share_of_force * alarms_a_stretch, goal).value;
}

TEST(ErrorsOfEstimators, HardlyGrowWithTheSpeedAndThresholdsThatDoAreLessThanAFifthLowerAtRest) {
  const Errors errors = errors_of(test::wanted("FLINCH_ROBOTS", 3));
  constexpr double bounds[] = {0.0, 0.1, 0.3, 0.6, 0.9, 1.2};
  std::printf("one sample in a thousand exceeds [N], below 0.1, 0.3, 0.6, 0.9 and 1.2 m/s:\n");
  for (const auto& [estimator, each] : errors) {
    std::printf("  %-26s", estimator.c_str());
    for (int i = 0; i < 5; ++i) std::printf(" %5.2f", force_exceeded(each, bounds[i], bounds[i + 1]));
    const double same = threshold_at_rest(each, 0.0), growing = threshold_at_rest(each, growth);
    std::printf("; threshold %5.2f N, or %5.2f N and %4.2f N for each rad/s: higher beyond %.1f rad/s\n",
                same, growing, growth * growing, (same / growing - 1.0) / growth);
    EXPECT_LT(force_exceeded(each, 0.9, 1.2), 1.5 * force_exceeded(each, 0.0, 0.1)) << estimator;
    EXPECT_GT(growing, 0.8 * same) << estimator << ": a robot at rest gains less than a fifth";
  }
}

// It knows neither bias nor delay of the IMU.
TEST(ErrorsOfEstimators, OfTheFilterAsPrintedNeedAThresholdAboveSixtyNewtons) {
  const Errors errors = errors_of(test::wanted("FLINCH_ROBOTS", 3), "direct_imu_ekf");
  const double printed = threshold_at_rest(errors.at("direct_imu_ekf"), 0.0);
  const double extended = threshold_at_rest(errors.at("direct_extended_imu_ekf"), 0.0);
  std::printf("threshold of direct_imu_ekf %.1f N, of direct_extended_imu_ekf %.1f N\n", printed, extended);
  EXPECT_GT(printed, 60.0);
  EXPECT_LT(extended, 15.0);
}

}  // namespace
}  // namespace flinch
