#include "experiments/campaign/run_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/campaign/campaign_run.h"
#include "experiments/verdict/verdict.h"

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

/// Two estimators that first noticed something at these times, and noticed the contact at those.
Verdict verdict_with(double onset, std::vector<std::optional<double>> first,
                     std::vector<std::optional<double>> contact_noticed) {
  Verdict verdict;
  ContactVerdict contact;
  contact.body = "leg3_clamping";
  contact.onset = onset;
  for (const char* name : {"observer", "filter"}) {
    const std::size_t i = verdict.first_noticed.size();
    verdict.first_noticed.push_back({name, first[i]});
    contact.detected_by.push_back({name, contact_noticed[i]});
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

TEST(AResult, TellsWhetherTheRobotCouldStopWhenItNoticedTheFirstContact) {
  Verdict verdict = verdict_with(0.5, {0.51, 0.52}, {0.51, 0.52});
  EXPECT_EQ(result_of(CampaignRun(), verdict).could_stop, std::nullopt);
  verdict.contacts[0].could_stop = false;
  const RunResult result = result_of(CampaignRun(), verdict);
  EXPECT_EQ(result.could_stop, false);
  EXPECT_EQ(parse_csv_row(csv_cells(csv_header(result)), csv_row(result))->could_stop, false);
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
  verdict.first_noticed.push_back({"observer", std::nullopt});
  const RunResult result = result_of(CampaignRun(), verdict);
  EXPECT_EQ(result.body, "none");
  EXPECT_EQ(result.estimators[0].contact_free, 3.0);
  EXPECT_FALSE(result.speed);
}

}  // namespace
}  // namespace flinch
