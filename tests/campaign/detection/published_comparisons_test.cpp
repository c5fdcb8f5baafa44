// The comparisons of observers in [RAL25] Table II and [ICRA23] III-D, by the campaigns that ship, with fewer
// robots each.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "experiments/campaign/campaign_summary.h"
#include "tests/campaign/detection/shipped_runs.h"

namespace flinch {
namespace {

/// Medians [ms] by estimator, in the order of the grid: of each point the four scenarios.
using Medians = std::map<std::string, std::vector<double>>;

Medians medians_of(const std::string& name, std::size_t robots) {
  std::map<std::string, std::map<std::size_t, std::vector<double>>> times;  // by estimator and point
  for (const RunResult& result : test::shipped_runs(name, robots)) {
    for (const EstimatorResult& by : result.estimators) {
      EXPECT_FALSE(by.false_alarm) << by.name << " in run " << result.run;
      times[by.name][result.point].push_back(1e3 * by.detection_time.value_or(1.0));
    }
  }
  Medians medians;
  for (auto& [estimator, by_point] : times) {
    std::printf("  %-26s", estimator.c_str());
    for (auto& [point, each] : by_point) {
      std::nth_element(each.begin(), each.begin() + static_cast<std::ptrdiff_t>(each.size() / 2), each.end());
      medians[estimator].push_back(each[each.size() / 2]);
      std::printf(" %5.1f%s", medians[estimator].back(), point % 4 == 3 ? "  |" : "");
    }
    std::printf("\n");
  }
  return medians;
}

TEST(Ral25TableII, HasItsOrderInEveryRowAndColumn) {
  constexpr std::size_t gains = 5, bodies = 4;  // 20 to 500 1/s; platform, first and second link, clamping
  const Medians medians = medians_of("detection_ral25", 5);
  const std::vector<double>& observer = medians.at("momentum_observer");
  const std::vector<double>& imu = medians.at("direct_extended_imu_ekf");
  ASSERT_EQ(observer.size(), gains * bodies);
  for (std::size_t i = 0; i < observer.size(); ++i) EXPECT_LT(imu[i], observer[i]) << i;
  for (std::size_t gain = 0; gain < gains; ++gain) {
    const double* const row = &observer[gain * bodies];
    EXPECT_LT(std::max(row[0], row[1]), row[2]) << "the second link after platform and first link";
    EXPECT_LT(row[2], row[3]) << "and clamping last";
  }
  // The plateau: five times the gain takes less than a third of the time off the platform's, and none off
  // that of clampings.
  const auto platform = [&](std::size_t gain) { return observer[gain * bodies]; };
  EXPECT_LT(platform(1) - platform(4), platform(1) / 3.0);
  EXPECT_GT(observer[4 * bodies + 3], observer[1 * bodies + 3]);
}

// The paper's gains of the sliding mode are not printed. With our default it is by more than 2 ms faster on
// the platform than the others; with those of 700 N/s it is within 2 ms of them, as in the paper.
TEST(Icra23, FindsTheSlidingModeFastestOnClampingsEvenWhereItIsAsSlowAsTheOthersOnThePlatform) {
  const Medians medians = medians_of("detection_icra23", 5);
  ASSERT_EQ(medians.size(), 3U);
  constexpr std::size_t platform = 0, clamping = 3, bodies = 4;
  const auto times = [&](std::size_t point) {
    return std::array{medians.at("momentum_observer").at(point),
                      medians.at("momentum_kalman_filter").at(point),
                      medians.at("sliding_mode_observer").at(point)};
  };
  for (const std::size_t gains : {std::size_t{0}, bodies}) {  // of the sliding mode: 3000 N/s, 700 N/s
    const auto [observer, kalman, sliding] = times(gains + clamping);
    EXPECT_LT(sliding, kalman);
    EXPECT_LT(kalman, observer);
  }
  const auto [observer, kalman, sliding] = times(platform);
  EXPECT_GT(std::min(observer, kalman) - sliding, 2.0);
  const auto slow = times(bodies + platform);
  EXPECT_LE(*std::max_element(slow.begin(), slow.end()) - *std::min_element(slow.begin(), slow.end()), 2.0);
}

}  // namespace
}  // namespace flinch
