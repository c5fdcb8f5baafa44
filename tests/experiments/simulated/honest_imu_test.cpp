// No scenario that ships spoils its IMU, so nobody may doubt it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/time.h"

namespace flinch {
namespace {

/// Cogging of drives that slide, of which the model does not know, shakes the platform faster than the IMU
/// can tell: it is called noisy, and so it is.
bool is_shaken(const std::filesystem::path& scenario) {
  const std::string name = scenario.stem().string();
  return name.starts_with("hexapod_calibration_") || name == "hexapod_collision_realistic" ||
         name == "linapod_collision_realistic";
}

TEST(AnHonestImu, IsBelievedInEveryScenario) {
  for (const auto& entry : std::filesystem::directory_iterator(FLINCH_SOURCE_DIR "/apps/scenarios")) {
    if (is_shaken(entry.path())) continue;
    SimulatedScenario scenario = read_simulated_scenario(entry.path());
    scenario.duration = std::min<Time>(scenario.duration, 6s);
    const Verdict verdict = judge_experiment(scenario);
    EXPECT_EQ(verdict.imu_doubt, ImuFault::none)
        << entry.path() << " from " << verdict.imu_doubted << " s on";
  }
}

/// Its drives change their torque by more from tick to tick than those of heavier robots.
TEST(AnHonestImu, IsBelievedOnALightRobotWhoseDrivesStep) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Verdict verdict = judge_experiment(
        read_simulated_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/five_bar_collision.yaml", seed));
    EXPECT_EQ(verdict.imu_doubt, ImuFault::none) << "seed " << seed;
  }
}

}  // namespace
}  // namespace flinch
