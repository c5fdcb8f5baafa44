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
                upper_rate(alarms.count, alarms.hours));
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

TEST(MismatchedRobots, NeedThresholdsOfTheirOwn) {  // the test above could not tell otherwise
  Campaign campaign = mismatched(24);
  const Campaign others = test::shipped("false_alarms", 24);
  for (CampaignAxis& axis : campaign.grid) {
    if (axis.key != "control.contact_detector.by_estimator" && axis.key != "control.fused_detector.residuals")
      continue;
    const auto same = [&axis](const CampaignAxis& other) { return other.key == axis.key; };
    axis = *std::find_if(others.grid.begin(), others.grid.end(), same);
  }
  for (const auto& [name, alarms] : alarms_in(campaign)) {
    const bool is_refuted = lower_rate(alarms.count, alarms.hours) > asked;
    EXPECT_EQ(is_refuted, name != "direct_extended_imu_ekf") << name;
  }
}

}  // namespace
}  // namespace flinch
