// A hexapod errs along its upright legs by more than across them, so a threshold for each component detects
// pushes from the side sooner. One robot is looked at; with FLINCH_ROBOTS=9 in the environment 9 set
// thresholds and 9 others are held against them, in eight minutes, which docs/observers.md cites.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "calibration/threshold_calibration.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

const int robots = test::wanted("FLINCH_ROBOTS", 1);

/// Of hexapods drawn by so many seeds from `first` on, each in 14 s of random motion.
EstimatorPeaks peaks_of_robots(std::uint64_t first, Time stretch) {
  std::vector<std::vector<EstimatorPeaks>> all;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(robots); ++seed) {
    const SimulatedScenario scenario = read_simulated_scenario(
        FLINCH_SOURCE_DIR "/apps/scenarios/hexapod_calibration_motion.yaml", {"plant.payload_kg=0"}, seed);
    all.push_back(contact_free_peaks(run_experiment(scenario), scenario.robot.robot->space(), stretch));
  }
  return pooled(all).front();
}

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

TEST(HexapodThresholds, WouldHaveToBeLargestAlongTheLegs) {
  const EstimatorPeaks peaks = peaks_of_robots(1, 500ms);
  const double across = std::max(largest(peaks.components[0]), largest(peaks.components[1]));
  std::printf("  across %.1f N, along %.1f N\n", across, largest(peaks.components[2]));
  EXPECT_GT(largest(peaks.components[2]), 1.5 * across);
}

TEST(HexapodThresholds, ByComponentAreHalfAsLargeAcrossTheLegsAndHoldForOtherRobots) {
  if (robots < 3) GTEST_SKIP() << "fewer than 30 s of motion set no thresholds; FLINCH_ROBOTS says how many";
  const ThresholdGoal goal{.by_component = true};
  const EstimatorPeaks peaks = peaks_of_robots(1, goal.stretch), others = peaks_of_robots(101, goal.stretch);
  const EstimatorThresholds found = calibrate_thresholds({peaks}, goal).front();
  std::printf("  one for all: %.0f N, %.1f Nm\n", found.force.value, found.moment.value);
  ASSERT_EQ(found.components.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    std::printf("  component %zu: %.3g, others reach %.3g\n", i, found.components[i].value,
                largest(others.components[i]));
    EXPECT_LT(largest(others.components[i]), found.components[i].value) << i;
  }
  EXPECT_LT(found.components[0].value, 0.6 * found.force.value);
  EXPECT_LT(found.components[1].value, 0.6 * found.force.value);
  EXPECT_LT(found.components[2].value, 1.3 * found.force.value) << "what the alarms cost that are shared";
}

}  // namespace
}  // namespace flinch
