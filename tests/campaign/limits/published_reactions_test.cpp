// The 72 experiments of [SafePR] V-G, whole: how soon contacts are over, with which force, and where robots
// end.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_result.h"
#include "tests/campaign/published_runs.h"

namespace flinch {
namespace {

using test::name_of;

constexpr double collision_asked = 0.125, clamping_asked = 0.275;  // [s]
constexpr double slowest = 0.1;                                    // [m/s]

bool is_slowest(const RunResult& run) { return run.speed.value_or(0.0) < 1.5 * slowest; }

double asked_of(const RunResult& run) {
  return body_of(run) == "clamping" ? clamping_asked : collision_asked;
}

void print(const std::vector<RunResult>& runs) {
  for (const ForceFit& fit : reactions_of(runs).fits)
    std::printf("  %-10s %.0f N + %.0f N/(m/s), r = %.3f\n", fit.body.c_str(), fit.intercept, fit.slope,
                fit.pearson);
  for (const ReactionGroup& group : reactions_of(runs).groups)
    std::printf("  %-12s %-10s removed %.0f ms (median), %.0f ms (longest); beyond kappa %zu, sc %zu\n",
                group.level.c_str(), group.body.c_str(), 1e3 * group.removed_median.value_or(9.0),
                1e3 * group.removed_largest.value_or(9.0), group.violations_sigma_kappa,
                group.violations_sigma_sc);
}

/// What both detectors must bring about: each contact is detected, over, below its limits and without a
/// fault.
void expect_good(const std::vector<RunResult>& runs) {
  ASSERT_EQ(runs.size(), 72U);
  std::size_t inside = 0;
  for (const RunResult& run : runs) {
    EXPECT_TRUE(run.estimators.at(0).detection_time) << name_of(run);
    EXPECT_TRUE(run.removal_time) << name_of(run);
    EXPECT_EQ(run.over_limit, 0.0) << name_of(run);
    EXPECT_EQ(run.fault, "") << name_of(run);
    EXPECT_FALSE(run.self_contact) << name_of(run);
    EXPECT_EQ(run.starts_inside, true) << name_of(run);
    inside += run.ends_inside ? 1U : 0U;
  }
  EXPECT_GE(inside, 65U) << "in 90 % of 72 both measures end inside";
}

// Forces that rise slowly reach the thresholds of the papers late, slow_clamping_test.cpp.
TEST(ThePublishedReactions, AreOverInTimeButForTheSlowestOfSecondLinksAndClampings) {
  const std::vector<RunResult> runs = test::published_runs("safepr_72_oracle.yaml");
  print(runs);
  expect_good(runs);
  std::size_t late = 0;
  for (const RunResult& run : runs) {
    const double removed = run.removal_time.value_or(9.0);
    if (removed <= asked_of(run)) continue;
    ++late;
    EXPECT_TRUE(is_slowest(run)) << name_of(run);
    EXPECT_TRUE(body_of(run) == "link2" || body_of(run) == "clamping") << name_of(run);
    std::printf("  late: %s, %.0f ms\n", name_of(run).c_str(), 1e3 * removed);
    EXPECT_LT(removed, body_of(run) == "link2" ? 0.25 : 0.55) << name_of(run);
  }
  EXPECT_EQ(late, 6U) << "both on three levels, docs/theory.md";
  const std::vector<ForceFit> fits = reactions_of(runs).fits;
  EXPECT_EQ(fits.size(), 4U);
  for (const ForceFit& fit : fits) EXPECT_GE(fit.pearson, 0.95) << fit.body;
}

// What is detected so soon hardly grows with the speed where a leg clamps.
TEST(ThePublishedReactions, AreAllOverInTimeWhereTheFusedDetectorNoticesThem) {
  const std::vector<RunResult> runs = test::published_runs("safepr_72_fused_oracle.yaml");
  print(runs);
  expect_good(runs);
  for (const RunResult& run : runs) EXPECT_LE(run.removal_time.value_or(9.0), asked_of(run)) << name_of(run);
  const std::vector<ForceFit> fits = reactions_of(runs).fits;
  EXPECT_EQ(fits.size(), 4U);
  for (const ForceFit& fit : fits) EXPECT_GE(fit.pearson, fit.body == "clamping" ? 0.9 : 0.95) << fit.body;
}

}  // namespace
}  // namespace flinch
