#include "calibration/thresholds_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "calibration/threshold_calibration.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

const std::vector<EstimatorThresholds> some = {
    {.estimator = "observer",
     .stretches = 180,
     .force = {6.25, 5.5, 4.0, 8.0},
     .moment = {0.5, 0.4, 0.3, 0.6}},
    {.estimator = "filter", .stretches = 180, .force = {7.5, 7.0, 5.0, 10.0}, .moment = {}}};

TEST(TheTable, ShowsThresholdsBesideThePapersRule) {
  const std::string table = thresholds_table(some, {});
  EXPECT_THAT(table, HasSubstr("2 x max"));
  EXPECT_THAT(table, HasSubstr("from 90.0 s of motion without contact"));
  EXPECT_THAT(table, HasSubstr("6.25"));
}

TEST(TheObject, HasEveryNumber) {
  const auto json = nlohmann::json::parse(thresholds_json(some, {}));
  EXPECT_EQ(json["false_alarms_per_h"], 0.5);
  EXPECT_EQ(json["thresholds"][0]["force_N"]["value"], 6.25);
  EXPECT_EQ(json["thresholds"][0]["moment_Nm"]["papers_rule"], 0.6);
  EXPECT_TRUE(json["thresholds"][1]["moment_Nm"].is_null());
}

TEST(TheSection, IsWhatAScenarioTakes) {
  EXPECT_EQ(
      thresholds_yaml(some, {}, {"a/run.h5"}),
      "# Thresholds for 0.5 false alarms an hour of each estimator, kept with a confidence of 95 %. From:\n"
      "#   a/run.h5\n"
      "# Belongs into the section 'control' of a scenario.\n"
      "contact_detector:\n"
      "  by_estimator:\n"
      "    - {estimator: observer, reaction_force_N: 6.25, reaction_moment_Nm: 0.5}\n"
      "    - {estimator: filter, reaction_force_N: 7.5}\n");
}

}  // namespace
}  // namespace flinch
