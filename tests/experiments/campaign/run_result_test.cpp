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
  result.detection_time = 0.1 + 0.2;
  result.false_alarm = true;
  result.contact_free = 1e-300;
  result.simulated = 1.2;
  return result;
}

TEST(ARowOfTheTable, ReadsBackBitForBit) {
  const RunResult result = some_result();
  const auto read = parse_csv_row(csv_header(result), csv_row(result));
  ASSERT_TRUE(read);
  EXPECT_EQ(csv_row(*read), csv_row(result));
  EXPECT_EQ(read->seed, result.seed);
  EXPECT_EQ(read->values, result.values);
  EXPECT_EQ(read->detection_time, result.detection_time);
  EXPECT_EQ(read->removal_time, std::nullopt);
  EXPECT_EQ(read->contact_free, result.contact_free);
}

TEST(ARowOfTheTable, IsNoneOnceAnyOfItIsMissing) {
  const RunResult result = some_result();
  const std::string header = csv_header(result), row = csv_row(result);
  for (std::size_t length = 0; length < row.rfind(','); ++length)
    EXPECT_FALSE(parse_csv_row(header, row.substr(0, length))) << row.substr(0, length);
  EXPECT_FALSE(parse_csv_row(header, row + ",1"));
  EXPECT_FALSE(parse_csv_row("", row));
}

TEST(CellsOfCsv, MayHoldCommasAndQuotes) {
  EXPECT_THAT(csv_cells("a,\"b,c\",\"say \"\"d\"\"\",,"), ElementsAre("a", "b,c", "say \"d\"", "", ""));
  EXPECT_TRUE(csv_cells("a,\"b").empty());
}

Verdict verdict_with(double onset, std::optional<double> detected, std::vector<double> detections) {
  Verdict verdict;
  ContactVerdict contact;
  contact.body = "leg3_clamping";
  contact.onset = onset;
  contact.detected = detected;
  verdict.contacts.push_back(contact);
  verdict.detections = std::move(detections);
  verdict.simulated = 1.0;
  return verdict;
}

TEST(AResult, CountsFromTheOnsetOfTheFirstContact) {
  const RunResult result = result_of(CampaignRun(), verdict_with(0.5, 0.51, {0.51}));
  EXPECT_EQ(result.body, "clamping");
  EXPECT_NEAR(*result.detection_time, 0.01, 1e-15);
  EXPECT_FALSE(result.false_alarm);
  EXPECT_EQ(result.contact_free, 0.5);
}

TEST(AResult, IsAFalseAlarmWhereSomethingWasDetectedBeforeAnythingTouched) {
  const RunResult result = result_of(CampaignRun(), verdict_with(0.5, std::nullopt, {0.2}));
  EXPECT_TRUE(result.false_alarm);
  EXPECT_EQ(result.contact_free, 0.2);
}

TEST(AResult, OfARunWithoutContactIsFreeOfItToTheEnd) {
  Verdict verdict;
  verdict.simulated = 3.0;
  const RunResult result = result_of(CampaignRun(), verdict);
  EXPECT_EQ(result.body, "none");
  EXPECT_EQ(result.contact_free, 3.0);
  EXPECT_FALSE(result.speed);
}

}  // namespace
}  // namespace flinch
