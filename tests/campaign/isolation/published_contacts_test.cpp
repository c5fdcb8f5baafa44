// The 72 experiments of [SafePR] V-G without an oracle: what the papers' networks tell, and what the strict
// level makes of what the learned classifier tells.
#if FLINCH_HAS_LEARNING
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_result.h"
#include "learning/network_stages.h"
#include "tests/campaign/published_runs.h"

namespace flinch {
namespace {

using test::name_of;

std::vector<RunResult> results_of(const char* name) {
  for (ContactClassifier& stage : network_stages(FLINCH_SOURCE_DIR "/apps/models"))
    add_known_classifier(std::move(stage));
  return test::published_runs(name);
}

/// Contacts of these bodies whose class was accepted and right.
std::size_t right_of(const std::vector<RunResult>& runs, const std::vector<std::string>& bodies) {
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), [&](const RunResult& run) {
    return run.class_right.value_or(false) &&
           std::find(bodies.begin(), bodies.end(), body_of(run)) != bodies.end();
  }));
}

// Nobody tells what is touched. The platform's contact acts 12 mm beside a coupling joint, docs/theory.md.
TEST(ThePublishedContacts, AreClassifiedRightByThePapersNetworksButForThePlatform) {
  const std::vector<RunResult> runs = results_of("safepr_72.yaml");
  ASSERT_EQ(runs.size(), 72U);
  for (const RunResult& run : runs) {
    EXPECT_TRUE(run.estimators.at(0).detection_time) << name_of(run);
    EXPECT_TRUE(run.class_right.has_value()) << name_of(run) << ": the papers always act on the likeliest";
    EXPECT_TRUE(run.removal_time || body_of(run) == "platform") << name_of(run);
  }
  EXPECT_EQ(right_of(runs, {"link1", "link2", "clamping"}), 54U);
  std::printf("  class right in %zu of 72\n", right_of(runs, {"platform", "link1", "link2", "clamping"}));
}

TEST(ThePublishedContacts, AreOverAndWithinAllLimitsOnTheStrictLevelWithoutAnOracle) {
  const std::vector<RunResult> runs = results_of("safepr_72_strict.yaml");
  ASSERT_EQ(runs.size(), 24U);
  for (const RunResult& run : runs) {
    EXPECT_LE(run.removal_time.value_or(9.0), 0.3) << name_of(run);
    EXPECT_FALSE(run.violates_sigma_kappa || run.violates_sigma_sc) << name_of(run);
    EXPECT_EQ(run.over_limit, 0.0) << name_of(run);
    EXPECT_EQ(run.fault, "") << name_of(run);
  }
}

}  // namespace
}  // namespace flinch
#endif
