#include "experiments/campaign/run_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "diagrams/task_stages.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/verdict/verdict.h"
#include "systems/laws/safety_filter.h"
#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;

RunResult some_result() {
  RunResult result;
  result.run = 12;
  result.point = 1;
  result.draw = 2;
  result.seed = 18446744073709551615U;
  result.values = {{"a.b", "[1, 2]"}, {"text", "says \"no\""}};
  result.fault = "a drive is hot; ticks, too";
  result.body = "link2";
  result.estimators = {
      {.name = "observer", .detection_time = 0.1 + 0.2, .contact_free = 0.5},
      {.name = "filter", .detection_time = std::nullopt, .false_alarm = true, .contact_free = 1e-300}};
  result.simulated = 1.2;
  return result;
}

TEST(ARowOfTheTable, ReadsBackBitForBit) {
  const RunResult result = some_result();
  const auto read = parse_csv_row(csv_cells(csv_header(result)), csv_row(result));
  ASSERT_TRUE(read);
  EXPECT_EQ(csv_row(*read), csv_row(result));
  EXPECT_EQ(read->seed, result.seed);
  EXPECT_EQ(read->values, result.values);
  ASSERT_EQ(read->estimators.size(), 2U);
  EXPECT_EQ(read->estimators[0].name, "observer");
  EXPECT_EQ(read->estimators[0].detection_time, result.estimators[0].detection_time);
  EXPECT_EQ(read->removal_time, std::nullopt);
  EXPECT_EQ(read->estimators[1].contact_free, 1e-300);
}

TEST(ARowOfTheTable, IsNoneOnceAnyOfItIsMissing) {
  const RunResult result = some_result();
  const std::vector<std::string> header = csv_cells(csv_header(result));
  const std::string row = csv_row(result);
  for (std::size_t length = 0; length < row.rfind(','); ++length)
    EXPECT_FALSE(parse_csv_row(header, row.substr(0, length))) << row.substr(0, length);
  EXPECT_FALSE(parse_csv_row(header, row + ",1"));
  EXPECT_FALSE(parse_csv_row({}, row));
}

TEST(CellsOfCsv, MayHoldCommasAndQuotes) {
  EXPECT_THAT(csv_cells("a,\"b,c\",\"say \"\"d\"\"\",,"), ElementsAre("a", "b,c", "say \"d\"", "", ""));
  EXPECT_TRUE(csv_cells("a,\"b").empty());
}

/// Two estimators that first detected something at these times, and detected the contact at those.
Verdict verdict_with(double onset, std::vector<std::optional<double>> first,
                     std::vector<std::optional<double>> contact_detected) {
  Verdict verdict;
  ContactVerdict contact;
  contact.body = "leg3_clamping";
  contact.onset = onset;
  for (const char* name : {"observer", "filter"}) {
    const std::size_t i = verdict.first_detected.size();
    verdict.first_detected.push_back({name, first[i]});
    contact.detected_by.push_back({name, contact_detected[i]});
  }
  verdict.contacts.push_back(contact);
  verdict.simulated = 1.0;
  return verdict;
}

TEST(AResult, CountsFromTheOnsetOfTheFirstContact) {
  const RunResult result = result_of(CampaignRun(), verdict_with(0.5, {0.51, 0.52}, {0.51, 0.52}));
  EXPECT_EQ(result.body, "clamping");
  ASSERT_EQ(result.estimators.size(), 2U);
  EXPECT_NEAR(*result.estimators[0].detection_time, 0.01, 1e-15);
  EXPECT_NEAR(*result.estimators[1].detection_time, 0.02, 1e-15);
  EXPECT_FALSE(result.estimators[0].false_alarm);
  EXPECT_EQ(result.estimators[0].contact_free, 0.5);
}

TEST(AResult, TellsWhetherTheRobotCouldStopWhenItDetectedTheFirstContact) {
  CampaignRun strict;
  keep_constraints_strictly(*test::planar_rig(), strict.scenario.control);
  Verdict verdict = verdict_with(0.5, {0.51, 0.52}, {0.51, 0.52});
  EXPECT_EQ(result_of(strict, verdict).could_stop, std::nullopt);
  verdict.contacts[0].could_stop = false;
  const RunResult result = result_of(strict, verdict);
  EXPECT_EQ(result.could_stop, false);
  EXPECT_EQ(parse_csv_row(csv_cells(csv_header(result)), csv_row(result))->could_stop, false);
}

// Violations are those of the safety values, so a stop within the limits of the gate says nothing about them.
TEST(AResult, TellsOfNoStopWithinLimitsThatAreWiderThanTheSafetyValues) {
  Verdict verdict = verdict_with(0.5, {0.51, 0.52}, {0.51, 0.52});
  verdict.contacts[0].could_stop = true;
  EXPECT_EQ(result_of(CampaignRun(), verdict).could_stop, std::nullopt);
}

/// Of a run that starts at the first pair of condition number and distance and goes to the second before the
/// detection, and is at the third from then on.
Verdict verdict_of_places(std::array<std::array<double, 2>, 3> at) {
  Verdict verdict;
  const auto range = [&at](std::size_t i, std::size_t from) {
    MeasureRange found{at[from][i], at[from][i], at[from][i], at[2][i]};
    for (std::size_t k = from; k < at.size(); ++k) {
      found.least = std::min(found.least, at[k][i]);
      found.most = std::max(found.most, at[k][i]);
    }
    return found;
  };
  verdict.measures = {range(0, 0), range(1, 0)};
  verdict.measures_once_detected = {range(0, 2), range(1, 2)};
  return verdict;
}

TEST(AResult, IsOfTheTimeFromTheDetectionOn) {
  const RunResult result =
      result_of(CampaignRun(), verdict_of_places({{{10.0, 0.18}, {16.0, 0.16}, {14.0, 0.171}}}));
  EXPECT_EQ(result.starts_inside, true);
  EXPECT_FALSE(result.violates_sigma_kappa || result.violates_sigma_sc);
  EXPECT_EQ(result.sigma_kappa_most, 14.0);
  EXPECT_EQ(result.sigma_sc_least, 0.171);
  EXPECT_EQ(parse_csv_row(csv_cells(csv_header(result)), csv_row(result))->starts_inside, true);
}

TEST(AResult, IsOfTheWholeTimeWhereLimitsAreKeptAlways) {
  CampaignRun run;
  run.scenario.control.limits.use = SafetyFilterSettings::Use::always;
  const RunResult result = result_of(run, verdict_of_places({{{10.0, 0.18}, {16.0, 0.16}, {14.0, 0.171}}}));
  EXPECT_TRUE(result.violates_sigma_kappa && result.violates_sigma_sc);
  EXPECT_EQ(result.sigma_kappa_most, 16.0);
  EXPECT_EQ(result.sigma_sc_least, 0.16);
  Verdict unnoticed = verdict_of_places({{{10.0, 0.18}, {16.0, 0.16}, {14.0, 0.171}}});
  unnoticed.measures_once_detected = {};
  EXPECT_TRUE(result_of(run, unnoticed).violates_sigma_kappa);
}

TEST(AResult, SaysWhoStartsOutsideAndNothingWhereNobodyMeasured) {
  EXPECT_EQ(
      result_of(CampaignRun(), verdict_of_places({{{15.1, 0.18}, {10.0, 0.18}, {10.0, 0.18}}})).starts_inside,
      false);
  EXPECT_EQ(result_of(CampaignRun(), verdict_of_places({{{10.0, 0.169}, {10.0, 0.18}, {10.0, 0.18}}}))
                .starts_inside,
            false);
  EXPECT_EQ(result_of(CampaignRun(), Verdict()).starts_inside, std::nullopt);
}

TEST(AResult, TellsHowFarMeasuresWentAndByWhichLimitsForcesAreJudged) {
  Verdict verdict = verdict_with(0.5, {0.51, 0.52}, {0.51, 0.52});
  verdict.measures_once_detected.sigma_kappa = {.first = 4.0, .least = 3.0, .most = 14.0, .last = 12.0};
  verdict.measures_once_detected.sigma_sc = {.first = 0.25, .least = 0.18, .most = 0.3, .last = 0.2};
  verdict.limits.transient = 65.0;
  verdict.largest_torque = 88.0;
  verdict.contacts[0].lasting_force = 30.0;
  const RunResult result = result_of(CampaignRun(), verdict);
  EXPECT_EQ(result.sigma_kappa_least, 3.0);
  EXPECT_EQ(result.sigma_sc_most, 0.3);
  EXPECT_EQ(result.transient_limit, 65.0);
  EXPECT_EQ(result.quasi_static_limit, 140.0);
  EXPECT_EQ(result.largest_torque, 88.0);
  EXPECT_EQ(result.lasting_force, 30.0);
  const auto read = parse_csv_row(csv_cells(csv_header(result)), csv_row(result));
  ASSERT_TRUE(read);
  EXPECT_EQ(csv_row(*read), csv_row(result));
  EXPECT_EQ(read->largest_torque, 88.0);
}

TEST(AResult, TellsWhetherTheRobotTookForTouchedWhatWas) {
  Verdict verdict = verdict_with(0.5, {0.51, 0.52}, {0.51, 0.52});
  EXPECT_EQ(result_of(CampaignRun(), verdict).class_right, std::nullopt) << "it was never sure";
  verdict.contacts[0].classified = "leg2_clamping";
  EXPECT_EQ(result_of(CampaignRun(), verdict).class_right, false) << "another leg";
  verdict.contacts[0].classified = "leg3_clamping";
  EXPECT_EQ(result_of(CampaignRun(), verdict).class_right, true);
  verdict.contacts[0].is_push = true;
  EXPECT_EQ(result_of(CampaignRun(), verdict).class_right, std::nullopt);
}

TEST(AResult, IsAFalseAlarmWhereSomethingWasDetectedBeforeAnythingTouched) {
  const RunResult result = result_of(CampaignRun(), verdict_with(0.5, {std::nullopt, 0.2}, {0.51, 0.51}));
  EXPECT_FALSE(result.estimators[0].false_alarm);
  EXPECT_TRUE(result.estimators[1].false_alarm);
  EXPECT_EQ(result.estimators[1].contact_free, 0.2);
}

TEST(AResult, CountsNoAlarmAfterTheRobotHasReactedToAnother) {
  const RunResult result =
      result_of(CampaignRun(), verdict_with(0.5, {0.2, 0.3}, {std::nullopt, std::nullopt}));
  EXPECT_TRUE(result.estimators[0].false_alarm);
  EXPECT_FALSE(result.estimators[1].false_alarm) << "what the robot does then is no motion without contact";
  EXPECT_EQ(result.estimators[1].contact_free, 0.2);
}

TEST(AResult, OfARunWithoutContactIsFreeOfItToTheEnd) {
  Verdict verdict;
  verdict.simulated = 3.0;
  verdict.first_detected.push_back({"observer", std::nullopt});
  const RunResult result = result_of(CampaignRun(), verdict);
  EXPECT_EQ(result.body, "none");
  EXPECT_EQ(result.estimators[0].contact_free, 3.0);
  EXPECT_FALSE(result.speed);
}

}  // namespace
}  // namespace flinch
