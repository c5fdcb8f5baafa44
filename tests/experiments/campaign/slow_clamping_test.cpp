// Why a leg that clamps at 0.1 m/s takes longer to open than the 275 ms of [SafePR] V-G, and what helps.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/simulated/experiment.h"
#include "experiments/verdict/recorded_truth.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recorded_values.h"

namespace flinch {
namespace {

constexpr double slowest = 0.1;     // [m/s]
constexpr double asked = 0.275;     // [s]
constexpr double largest_N = 10.0;  // thresholds of [SafePR]
constexpr double largest_Nm = 1.0;

struct SlowClamping {
  double reached = 0.0;   ///< from the onset until the true wrench reaches the papers' thresholds [s]
  double detected = 0.0;  ///< likewise until the robot detects
  double removed = 0.0;
};

SlowClamping measured(const CampaignRun& run) {
  const Recording recording = run_experiment(run.scenario);
  const Verdict verdict = judge(recording, run.scenario.robot.robot->space(), run.scenario.expected, {});
  const ContactVerdict& contact = verdict.contacts.at(0);
  SlowClamping found{.reached = std::nan(""),
                     .detected = contact.detected.value_or(std::nan("")) - contact.onset,
                     .removed = contact.removed.value_or(std::nan("")) - contact.onset};
  const auto truths = read<RecordedTruth>(recording, "truth");
  for (std::size_t k = 0; k < recording.samples() && std::isnan(found.reached); ++k) {
    const PlatformVector F = truths[k].wrench_in_base;
    if (F.head(2).lpNorm<Eigen::Infinity>() >= largest_N || std::abs(F[2]) >= largest_Nm)
      found.reached = to_seconds(Time(recording.time_ns[k])) - contact.onset;
  }
  return found;
}

/// The clampings at 0.1 m/s of a campaign, on the three levels.
std::vector<SlowClamping> slow_clampings(const std::string& name, const std::string& set = "") {
  CampaignOverrides overrides;
  overrides.set = {"motion.speed_m_per_s=" + std::to_string(slowest)};
  if (!set.empty()) overrides.set.push_back(set);
  const Campaign campaign =
      read_campaign(std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/campaigns" / name, overrides);
  std::vector<SlowClamping> all;
  for (std::size_t number = 0; number < campaign.runs(); ++number) {
    const CampaignRun run = draw_run(campaign, number);
    if (run.scenario.expected.contact != "leg1_clamping") continue;
    all.push_back(measured(run));
    std::printf("  %s: 10 N or 1 Nm after %.0f ms, detected %.0f ms, removed %.0f ms\n", name.c_str(),
                1e3 * all.back().reached, 1e3 * all.back().detected, 1e3 * all.back().removed);
  }
  EXPECT_EQ(all.size(), 3U);
  return all;
}

TEST(AClampingAtLowSpeed, ReachesThePapersThresholdsTooLateForAnyEstimator) {
  for (const SlowClamping& one : slow_clampings("safepr_72_oracle.yaml")) {
    EXPECT_GT(one.reached, asked);
    EXPECT_LT(one.detected - one.reached, 0.06) << "the observer's part";
    EXPECT_LT(one.removed - one.detected, 0.07) << "the reaction's part";
  }
}

TEST(AClampingAtLowSpeed, IsOverInTimeWhereTheFusedDetectorNoticesIt) {
  for (const SlowClamping& one : slow_clampings("safepr_72_fused_oracle.yaml")) EXPECT_LE(one.removed, asked);
}

}  // namespace
}  // namespace flinch
