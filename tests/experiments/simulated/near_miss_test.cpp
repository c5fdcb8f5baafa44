#include "experiments/simulated/near_miss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "experiments/report/scenario_verdict.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/recording.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

SimulatedScenario shipped(const std::string& name, const std::vector<std::string>& set) {
  return read_simulated_scenario(test::shipped("scenarios/" + name + ".yaml"), set);
}

std::vector<std::string> failures_of(const SimulatedScenario& scenario) {
  return verdict_of(scenario, run_experiment(scenario)).failures;
}

/// What a sentence asks for, a tenth farther, of an obstacle that stands at x and y, or also z [mm].
std::vector<std::string> moved_as(const std::string& sentence, const std::string& key,
                                  const std::vector<double>& from) {
  static const std::regex by("by (-?\\d+)");
  std::vector<std::string> set;
  std::size_t axis = 0;
  for (std::sregex_iterator it(sentence.begin(), sentence.end(), by), end; it != end; ++it, ++axis) {
    const double change = std::stod((*it)[1]);
    set.push_back(key + "." + "xyz"[axis] + "_mm=" +
                  std::to_string(from.at(axis) + 1.1 * change +
                                 (change > 0   ? 1.0
                                  : change < 0 ? -1.0
                                               : 0.0)));
  }
  return set;
}

TEST(NearMiss, TellsHowFarAPylonIsFromThePlatformAndMovedThereItIsTouched) {
  const std::string x = "pylon.x_mm=-420", y = "pylon.y_mm=-60";
  const std::vector<std::string> failures = failures_of(shipped("platform_collision", {x, y}));
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_THAT(failures[0], HasSubstr("nothing was touched"));
  EXPECT_THAT(failures[1], HasSubstr("platform came nearest to pylon"));
  const SimulatedScenario moved =
      shipped("platform_collision", moved_as(failures[1], "pylon", {-420.0, -60.0}));
  EXPECT_FALSE(verdict_of(moved, run_experiment(moved)).contacts.empty()) << failures[1];
}

TEST(NearMiss, TellsOfWhatLiesBehind) {
  const std::vector<std::string> failures =
      failures_of(shipped("platform_collision", {"pylon.x_mm=400", "duration_s=0.4"}));
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_THAT(failures[1], HasSubstr("ever came nearer"));
}

TEST(NearMiss, TellsItInSpaceToo) {
  const std::string x = "obstacles[0].x_mm=320", y = "obstacles[0].y_mm=60", z = "obstacles[0].z_mm=-780";
  const std::vector<std::string> failures = failures_of(shipped("tricept_collision", {x, y, z}));
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_THAT(failures[1], HasSubstr("platform came nearest to ball"));
  const SimulatedScenario moved =
      shipped("tricept_collision", moved_as(failures[1], "obstacles[0]", {320.0, 60.0, -780.0}));
  EXPECT_FALSE(verdict_of(moved, run_experiment(moved)).contacts.empty()) << failures[1];
}

TEST(NearMiss, SaysNothingWithoutAnObstacle) {
  const SimulatedScenario scenario = shipped("square", {"duration_s=0.4"});
  EXPECT_THAT(near_miss(scenario, run_experiment(scenario)), IsEmpty());
}

}  // namespace
}  // namespace flinch
