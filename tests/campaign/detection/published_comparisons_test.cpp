// The comparisons of observers in [RAL25] Table II and [ICRA23] III-D, by the campaigns that ship, with fewer
// robots each, or with as many as FLINCH_ROBOTS says; docs/observers.md cites 20.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "experiments/campaign/campaign_summary.h"
#include "tests/campaign/detection/shipped_runs.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

/// Medians [ms] by estimator, in the order of the grid: of each point the four scenarios.
using Medians = std::map<std::string, std::vector<double>>;

Medians medians_of(const std::string& name) {
  const auto robots = test::wanted<std::size_t>("FLINCH_ROBOTS", 5);
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
      const std::size_t middle = (each.size() - 1) / 2;  // as the campaign takes it
      std::nth_element(each.begin(), each.begin() + static_cast<std::ptrdiff_t>(middle), each.end());
      medians[estimator].push_back(each[middle]);
      std::printf(" %5.1f%s", medians[estimator].back(), point % 4 == 3 ? "  |" : "");
    }
    std::printf("\n");
  }
  return medians;
}

// Of the orders in the paper all are found but that of platform and first link.
TEST(Ral25TableII, HasTheImuFirstTheSecondLinkAfterTheFirstAndClampingsLast) {
  constexpr std::size_t gains = 5, bodies = 4;  // 20 to 500 1/s; platform, first and second link, clamping
  const Medians medians = medians_of("detection_ral25");
  const std::vector<double>& observer = medians.at("momentum_observer");
  const std::vector<double>& imu = medians.at("direct_extended_imu_ekf");
  ASSERT_EQ(observer.size(), (gains + 1) * bodies);
  for (std::size_t i = 0; i < gains * bodies; ++i) EXPECT_LT(imu[i], observer[i]) << i;
  for (std::size_t gain = 0; gain < gains; ++gain) {
    const double* const row = &observer[gain * bodies];
    EXPECT_LT(std::max(row[0], row[1]), row[2]) << "the second link after platform and first link";
    EXPECT_LT(row[2], row[3]) << "and clamping last";
    EXPECT_GT(row[0], row[1]) << "in the paper the platform comes before the first link";
    EXPECT_LT(imu[gain * bodies], imu[gain * bodies + 1]) << "as it does for the IMU";
  }
  // The plateau: five times the gain takes less than a third of the time off the platform's, and none off
  // that of clampings.
  const auto platform = [&](std::size_t gain) { return observer[gain * bodies]; };
  EXPECT_LT(platform(1) - platform(4), platform(1) / 3.0);
  EXPECT_GT(observer[4 * bodies + 3], observer[1 * bodies + 3]);

  // Table III: by how much the IMU is earlier than the observer at 135 1/s; 50, 40, 32, 17 % in the paper,
  // where both have 29 N.
  for (const std::size_t thresholds : {std::size_t{2}, gains}) {
    std::printf(thresholds == gains ? "  Table III, at the same threshold:"
                                    : "  Table III, each at its own:");
    for (std::size_t body = 0; body < bodies; ++body) {
      const std::size_t at = thresholds * bodies + body;
      std::printf(" %.0f %%", 100.0 * (1.0 - imu[at] / observer[at]));
      EXPECT_LE(imu[at], observer[at]) << body;
    }
    std::printf("\n");
  }
}

// The paper's gains of the sliding mode are not printed. With our default it is by more than 2 ms faster on
// the platform than the others; with those of 700 N/s it is within 2 ms of them, as in the paper.
TEST(Icra23, FindsTheSlidingModeFastestOnClampingsEvenWhereItIsAsSlowAsTheOthersOnThePlatform) {
  const Medians medians = medians_of("detection_icra23");
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
