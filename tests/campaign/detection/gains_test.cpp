// The momentum observer alone at several gains, each with the thresholds of the same rate of false alarms, on
// a part of the contacts of the campaign that ships.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "tests/campaign/detection/shipped_runs.h"

namespace flinch {
namespace {

TEST(GainsOfTheMomentumObserver, AreTheFasterTheHigherUpToThreeHundred) {
  constexpr double missed = 0.1;          // [s]
  std::map<std::string, double> seconds;  // by settings: of all contacts, each counted as missed at most
  std::size_t contacts = 0;
  for (const RunResult& result : test::shipped_runs("detection_gains", 10)) {
    const auto settings = std::find_if(result.values.begin(), result.values.end(),
                                       [](const auto& value) { return value.first == "control"; });
    seconds[settings->second] += std::min(result.estimators.front().detection_time.value_or(missed), missed);
    ++contacts;
  }
  ASSERT_EQ(contacts, 240U);
  const auto mean = [&](int gain, int filter) {  // [ms]
    const std::string with_gain = "gain_per_s: [" + std::to_string(gain) + ",";
    const std::string with_filter = "cutoff_frequency_Hz: " + std::to_string(filter) + "}";
    for (const auto& [settings, sum] : seconds) {
      const bool same =
          settings.find(with_gain) != std::string::npos && settings.find(with_filter) != std::string::npos;
      if (same) return 1e3 * sum / 40.0;
    }
    ADD_FAILURE() << "no gain of " << gain << " 1/s at " << filter << " Hz";
    return 0.0;
  };
  constexpr std::pair<int, int> all[] = {{20, 30}, {100, 30}, {300, 30}, {100, 60}, {300, 60}, {500, 60}};
  for (const auto& [gain, filter] : all)
    std::printf("  %3d 1/s, %2d Hz: %5.1f ms in the mean of 40 contacts\n", gain, filter, mean(gain, filter));
  EXPECT_LT(mean(100, 30), 0.85 * mean(20, 30));
  EXPECT_LT(mean(300, 30), mean(100, 30));
  EXPECT_LT(mean(300, 60), mean(300, 30));
  EXPECT_GT(mean(500, 60), mean(300, 60)) << "its threshold has grown by more";
}

}  // namespace
}  // namespace flinch
