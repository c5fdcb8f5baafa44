// False alarms of robots that are further off their model: friction by up to 30 %, the platform by 5 %,
// torque constants by 5 %. FLINCH_ROBOTS in the environment says how many robots, 36 s of motion each;
// docs/observers.md cites 692.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "experiments/campaign/exact_bounds.h"
#include "tests/campaign/detection/shipped_runs.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr double asked = 0.5;  // false alarms an hour of each, for which all thresholds were calibrated

/// What detectors saw in motion without contact.
struct Alarms {
  std::size_t count = 0;
  double hours = 0.0;
};

/// By estimator, and of the fused detector.
std::map<std::string, Alarms> alarms_in(const Campaign& campaign) {
  std::map<std::string, Alarms> by;
  for (const RunResult& result : test::runs_of(campaign)) {
    EXPECT_EQ(result.body, "none") << "something touched the robot of run " << result.run;
    EXPECT_EQ(result.fault, "") << "run " << result.run;
    for (const EstimatorResult& each : result.estimators) {
      by[each.name].count += each.false_alarm ? 1 : 0;
      by[each.name].hours += each.contact_free / 3600.0;
    }
  }
  for (const auto& [name, alarms] : by) {
    std::printf("  %-26s %2zu false alarms in %.2f h: between %.2f and %.2f an hour, each by 95 %%\n",
                name.c_str(), alarms.count, alarms.hours, lower_rate(alarms.count, alarms.hours),
                garwood_upper(alarms.count, alarms.hours));
  }
  return by;
}

Campaign mismatched(std::size_t robots) { return test::shipped("false_alarms_mismatched", robots); }

TEST(MismatchedRobots, RaiseFalseAlarmsAtTheRateForWhichTheirThresholdsWereCalibrated) {
  const std::map<std::string, Alarms> by =
      alarms_in(mismatched(test::wanted<std::size_t>("FLINCH_ROBOTS", 24)));
  EXPECT_EQ(by.size(), 7U);
  for (const auto& [name, alarms] : by)
    EXPECT_LE(lower_rate(alarms.count, alarms.hours), asked) << name << ": so many refute the rate asked";
  EXPECT_GT(by.at("fused_detector").hours, 0.2);
}

/// The values of an axis that another campaign has as well.
CampaignAxis axis_of(const Campaign& campaign, const std::string& key) {
  return *std::find_if(campaign.grid.begin(), campaign.grid.end(),
                       [&key](const CampaignAxis& axis) { return axis.key == key; });
}

bool refuted(const Alarms& alarms) { return lower_rate(alarms.count, alarms.hours) > asked; }

// The test above could not tell otherwise. For the fused detector the next one shows it.
TEST(MismatchedRobots, NeedThresholdsOfTheirOwnForAllPlainDetectorsButOne) {
  Campaign campaign = mismatched(24);
  const Campaign others = test::shipped("false_alarms", 24);
  for (CampaignAxis& axis : campaign.grid) {
    if (axis.key == "calibrations") axis = axis_of(others, axis.key);
  }
  for (const auto& [name, alarms] : alarms_in(campaign)) {
    if (name == "fused_detector") continue;
    EXPECT_EQ(refuted(alarms), name != "direct_extended_imu_ekf") << name;
  }
}

TEST(MismatchedRobots, RefuteTheFusedDetectorAtThresholdsOfMoreFalseAlarms) {
  Campaign campaign = mismatched(12);
  CampaignAxis fifty_an_hour = axis_of(test::shipped("false_alarms_rates", 12), "calibrations");
  fifty_an_hour.values.resize(1);
  for (CampaignAxis& axis : campaign.grid) {
    if (axis.key == "calibrations") axis = fifty_an_hour;
  }
  EXPECT_TRUE(refuted(alarms_in(campaign).at("fused_detector")));
}

}  // namespace
}  // namespace flinch
