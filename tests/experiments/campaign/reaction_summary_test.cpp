#include "experiments/campaign/reaction_summary.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "experiments/campaign/campaign.h"

namespace flinch {
namespace {

RunResult run(const std::string& law, const std::string& meant, double removal, double speed, double peak) {
  RunResult result;
  result.law = law;
  result.meant = meant;
  result.body = "link2";
  result.removal_time = removal;
  result.speed = speed;
  result.peak_force = peak;
  result.ends_inside = true;
  result.estimators = {{.name = "observer", .detection_time = 0.01}};
  return result;
}

TEST(ReactionSummary, GroupsByLevelAndByTheBodyThatWasMeant) {
  const ReactionSummary summary = reactions_of({run("torque_reaction", "clamping", 0.1, 1.0, 100.0),
                                                run("torque_reaction", "clamping", 0.2, 0.5, 50.0),
                                                run("torque_reaction", "", 0.1, 1.0, 100.0),
                                                run("retraction", "clamping", 0.1, 1.0, 100.0)});
  ASSERT_EQ(summary.groups.size(), 3U);
  EXPECT_EQ(summary.groups[0].level, "retraction");
  EXPECT_EQ(summary.groups[1].level, "torque");
  EXPECT_EQ(summary.groups[1].body, "clamping");
  EXPECT_EQ(summary.groups[1].n, 2U);
  EXPECT_EQ(summary.groups[2].body, "link2");
}

TEST(ReactionSummary, CountsWhatRunsShow) {
  RunResult bad = run("torque_reaction", "platform", 0.3, 1.0, 300.0);
  bad.over_limit = 0.01;
  bad.violates_sigma_kappa = bad.violates_sigma_sc = bad.self_contact = true;
  bad.ends_inside = false;
  bad.fault = "a drive is too fast";
  bad.estimators.front().detection_time.reset();
  bad.class_right = false;
  RunResult good = run("torque_reaction", "platform", 0.1, 0.5, 80.0);
  good.class_right = true;
  const ReactionGroup group = reactions_of({bad, good}).groups[0];
  EXPECT_EQ(group.n, 2U);
  EXPECT_EQ(group.class_right, 1U);
  EXPECT_EQ(group.class_wrong, 1U);
  EXPECT_EQ(group.removed, 2U);
  EXPECT_EQ(group.detected, 1U);
  EXPECT_EQ(group.over_limit, 1U);
  EXPECT_EQ(group.violations_sigma_kappa, 1U);
  EXPECT_EQ(group.violations_sigma_sc, 1U);
  EXPECT_EQ(group.self_collisions, 1U);
  EXPECT_EQ(group.final_inside, 1U);
  EXPECT_EQ(group.gate_faults, 1U);
  EXPECT_EQ(group.removed_median, 0.1);
  EXPECT_EQ(group.removed_p95, 0.3);
  EXPECT_EQ(group.peak_largest, 300.0);
}

TEST(ReactionSummary, CountsWhoCouldStopAndWentBeyondALimitNevertheless) {
  RunResult could = run("strict_reaction", "platform", 0.1, 1.0, 100.0), could_not = could, nobody = could;
  could.could_stop = true;
  could_not.could_stop = false;
  could_not.violates_sigma_sc = true;
  RunResult beyond = could;
  beyond.violates_sigma_kappa = beyond.violates_sigma_sc = true;
  const ReactionGroup group = reactions_of({could, could, beyond, could_not, nobody}).groups.at(0);
  EXPECT_EQ(group.could_stop, 3U);
  EXPECT_EQ(group.could_not_stop, 1U);
  EXPECT_EQ(group.violations_could_stop, 1U);
}

TEST(ReactionSummary, CountsNoStopsWhereNobodyJudgedThem) {
  RunResult judged = run("strict_reaction", "platform", 0.1, 1.0, 100.0);
  judged.could_stop = true;
  const auto groups = nlohmann::json::parse(reactions_json(
      {}, reactions_of({judged, run("torque_reaction", "platform", 0.1, 1.0, 100.0)}), {}))["groups"];
  EXPECT_EQ(groups[0]["could_stop"], 1);
  EXPECT_EQ(groups[0]["could_not_stop"], 0);
  EXPECT_EQ(groups[0]["violations_could_stop"], 0);
  for (const char* key : {"could_stop", "could_not_stop", "violations_could_stop"})
    EXPECT_TRUE(groups[1][key].is_null()) << key;
}

TEST(ReactionSummary, TellsHowContactsWereNoticedAsThatOfDetectionsDoes) {
  std::vector<RunResult> runs;
  for (int i = 1; i <= 9; ++i) {
    runs.push_back(run("torque_reaction", "platform", 0.1, 1.0, 100.0));
    runs.back().estimators = {{.name = "observer", .detection_time = 1e-3 * i, .contact_free = 360.0},
                              {.name = "filter"}};
  }
  runs.push_back(runs.back());
  runs.back().estimators[0].detection_time = 0.06;
  runs.push_back(runs.front());
  runs.back().estimators[0].false_alarm = true;
  const auto group = nlohmann::json::parse(reactions_json({}, reactions_of(runs, 0.05), {}))["groups"][0];
  EXPECT_EQ(group["estimator"], "observer");
  EXPECT_EQ(group["n"], 11);
  EXPECT_EQ(group["contacts"], 10);
  EXPECT_EQ(group["missed"], 1) << "it was detected later than that";
  EXPECT_NEAR(group["median_ms"], 5.0, 1e-9);
  EXPECT_NEAR(group["p90_ms"], 9.0, 1e-9);
  EXPECT_NEAR(group["missed_share_at_most"], 0.3942, 1e-4);  // 1 of 10, Clopper and Pearson
  EXPECT_EQ(group["false_alarms"], 1);
  EXPECT_NEAR(group["false_alarms_per_h"], 1.0 / 1.1, 1e-9);
  EXPECT_NEAR(group["false_alarms_per_h_at_most"], 4.7439 / 1.1, 1e-3);
}

TEST(ReactionSummary, NamesNoEstimatorWhereSeveralWereFollowed) {
  RunResult other = run("torque_reaction", "platform", 0.1, 1.0, 100.0);
  other.estimators.front().name = "filter";
  const ReactionSummary summary =
      reactions_of({run("torque_reaction", "platform", 0.1, 1.0, 100.0), other, other});
  EXPECT_EQ(summary.groups[0].detection.contacts, 3U);
  EXPECT_TRUE(nlohmann::json::parse(reactions_json({}, summary, {}))["groups"][0]["estimator"].is_null());
}

// Who starts outside of a limit does not break it.
TEST(ReactionSummary, CountsTheViolationsOfRunsThatStartWithinBothLimitsApart) {
  RunResult inside = run("torque_reaction", "platform", 0.1, 1.0, 100.0), outside = inside, beyond = inside;
  inside.starts_inside = beyond.starts_inside = true;
  outside.starts_inside = false;
  outside.violates_sigma_kappa = outside.violates_sigma_sc = beyond.violates_sigma_sc = true;
  const ReactionSummary summary = reactions_of({inside, inside, outside, beyond});
  const ReactionGroup& group = summary.groups.at(0);
  EXPECT_EQ(group.starts_inside, 3U);
  EXPECT_EQ(group.violations_sigma_kappa, 1U);
  EXPECT_EQ(group.violations_sigma_sc, 2U);
  EXPECT_EQ(group.starts_inside_violations_sigma_kappa, 0U);
  EXPECT_EQ(group.starts_inside_violations_sigma_sc, 1U);
  const auto json = nlohmann::json::parse(reactions_json({}, summary, {}))["groups"][0];
  EXPECT_EQ(json["starts_inside"], 3);
  EXPECT_EQ(json["starts_inside_violations_sigma_kappa"], 0);
  EXPECT_EQ(json["starts_inside_violations_sigma_sc"], 1);
  EXPECT_THAT(reactions_table({}, summary), testing::ContainsRegex("3 +0/1 +1/2"));
}

// A contact that is not over at the end has no time of removal: it counts as longer than all others.
TEST(ReactionSummary, AContactThatStaysIsLongerThanAllOthers) {
  RunResult stays = run("torque_reaction", "platform", 0.0, 1.0, 100.0);
  stays.removal_time.reset();
  const ReactionGroup group =
      reactions_of({stays, run("torque_reaction", "platform", 0.1, 0.5, 80.0)}).groups[0];
  EXPECT_EQ(group.removed_median, 0.1);
  EXPECT_EQ(group.removed_p95, std::nullopt);
  EXPECT_EQ(group.removed_largest, 0.1);
}

TEST(LineThroughForces, IsThatOfLeastSquares) {
  const auto exact = fit_line({0.1, 0.5, 1.5}, {23.0 + 13.2, 23.0 + 66.0, 23.0 + 198.0});
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->slope, 132.0, 1e-9);
  EXPECT_NEAR(exact->intercept, 23.0, 1e-9);
  EXPECT_NEAR(exact->pearson, 1.0, 1e-12);
  // By hand: means 2 and 2, xy = 1, xx = 2, yy = 2.
  const auto scattered = fit_line({1.0, 2.0, 3.0}, {1.0, 3.0, 2.0});
  EXPECT_NEAR(scattered->slope, 0.5, 1e-12);
  EXPECT_NEAR(scattered->intercept, 1.0, 1e-12);
  EXPECT_NEAR(scattered->pearson, 0.5, 1e-12);
}

/// A run that reached the force that a line has at its speed, judged by the limits of the hand.
RunResult on_line(const std::string& body, double speed, double intercept, double slope) {
  RunResult result = run("torque_reaction", body, 0.1, speed, intercept + slope * speed);
  result.transient_limit = 280.0;
  result.quasi_static_limit = 140.0;
  return result;
}

// [SafePR] Table V, its lines of platform and clamping.
TEST(LineThroughForces, IsFollowedToTheLimits) {
  std::vector<RunResult> runs;
  for (const double speed : {0.1, 0.7, 1.5}) {
    runs.push_back(on_line("clamping", speed, 34.0, 94.0));
    runs.push_back(on_line("platform", speed, 23.0, 132.0));
  }
  const ReactionSummary summary = reactions_of(runs);
  ASSERT_EQ(summary.fits.size(), 2U);
  EXPECT_NEAR(*summary.fits[0].speed_at_transient, 2.62, 0.005);
  EXPECT_NEAR(*summary.fits[0].speed_at_quasi_static, 1.13, 0.005);
  EXPECT_NEAR(*summary.fits[1].speed_at_transient, 1.95, 0.005);
  ASSERT_TRUE(summary.fit_of_all);
  EXPECT_EQ(summary.fit_of_all->n, 6U);
  EXPECT_NEAR(summary.fit_of_all->slope, (94.0 + 132.0) / 2.0, 1e-9) << "both at the same speeds";
  EXPECT_LT(summary.fit_of_all->pearson, 0.999);

  const auto json = nlohmann::json::parse(reactions_json({}, summary, {}));
  EXPECT_NEAR(json["fits"][1]["speed_at_transient_limit_m_per_s"].get<double>(), 1.95, 0.005);
  EXPECT_EQ(json["fit_of_all"]["n"], 6);
  EXPECT_THAT(reactions_table({}, summary), testing::HasSubstr("2.62"));
}

TEST(LineThroughForces, ReachesNoLimitThatDiffersBetweenRunsOrThatItMovesAwayFrom) {
  std::vector<RunResult> runs = {on_line("platform", 0.1, 20.0, 100.0), on_line("platform", 0.5, 20.0, 100.0),
                                 on_line("platform", 1.5, 20.0, 100.0)};
  runs[1].quasi_static_limit = 65.0;
  EXPECT_EQ(reactions_of(runs).fits.at(0).speed_at_quasi_static, std::nullopt);
  EXPECT_NEAR(*reactions_of(runs).fits.at(0).speed_at_transient, 2.6, 1e-9);
  const auto falling =
      reactions_of({on_line("platform", 0.1, 100.0, -10.0), on_line("platform", 0.5, 100.0, -10.0),
                    on_line("platform", 1.5, 100.0, -10.0)});
  EXPECT_EQ(falling.fits.at(0).speed_at_transient, std::nullopt);
}

TEST(ReactionSummary, TellsHowLongAForceWasAboveItsLimitAtMost) {
  RunResult briefly = run("torque_reaction", "platform", 0.1, 0.5, 300.0), longer = briefly;
  briefly.over_limit = 0.002;
  longer.over_limit = 0.01;
  const auto summary = reactions_of({longer, briefly});
  EXPECT_EQ(nlohmann::json::parse(reactions_json({}, summary, {}))["groups"][0]["over_limit_ms_max"], 10.0);
}

TEST(LineThroughForces, IsNoneWithoutEnoughPoints) {
  EXPECT_FALSE(fit_line({1.0, 2.0}, {1.0, 2.0}));
  EXPECT_FALSE(fit_line({1.0, 1.0, 1.0}, {1.0, 2.0, 3.0}));
}

TEST(ReactionSummary, IsOneJsonObjectWithTheGroupsAndTheLines) {
  Campaign campaign;
  campaign.name = "some";
  const ReactionSummary summary = reactions_of({run("torque_reaction", "platform", 0.1, 0.5, 50.0),
                                                run("torque_reaction", "platform", 0.1, 1.0, 100.0),
                                                run("torque_reaction", "platform", 0.1, 1.5, 150.0)});
  const auto json = nlohmann::json::parse(reactions_json(campaign, summary, {}));
  const auto& group = json["groups"][0];
  for (const char* key :
       {"level", "body", "n", "detected", "class_right", "class_wrong", "removed", "removed_median_ms",
        "removed_p95_ms", "peak_median_N", "peak_max_N", "over_limit", "violations_sigma_kappa",
        "violations_sigma_sc", "self_collisions", "gate_faults"}) {
    EXPECT_TRUE(group.contains(key)) << key;
  }
  EXPECT_EQ(group["removed_median_ms"], 100.0);
  EXPECT_NEAR(json["fits"][0]["slope_N_s_per_m"].get<double>(), 100.0, 1e-9);
  EXPECT_THAT(reactions_table(campaign, summary), testing::HasSubstr("platform       3   1.000      100 "));
}

}  // namespace
}  // namespace flinch
