// flinch campaign, as typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CampaignVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    place.write("campaigns/few.yaml",
                "scenario: ../scenarios/platform_collision.yaml\n"
                "runs: 2\n"
                "contact: {body: [platform]}\n"
                "draw: [{key: motion.direction_deg, from: 0, to: 360}]\n");
  }
  Outcome campaign(std::vector<std::string> options) const {
    options.insert(options.begin(), {"campaign", place.at("campaigns/few.yaml"), "--out", place.at("out")});
    return flinch(options);
  }

  test::Workplace place;
};

TEST_F(CampaignVerb, PrintsATableAndLeavesItInTwoFormats) {
  const Outcome outcome = campaign({});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("platform"));
  EXPECT_THAT(outcome.err, HasSubstr("results.csv"));
  EXPECT_FALSE(test::bytes_of(place / "out/results.csv").empty());
  EXPECT_FALSE(test::bytes_of(place / "out/results.h5").empty());
}

TEST_F(CampaignVerb, DoesNothingTwice) {
  campaign({});
  const auto json = nlohmann::json::parse(campaign({"--json"}).out);
  EXPECT_EQ(json["runs"], 2);
  EXPECT_EQ(json["runs_per_s"], 0.0);
  EXPECT_EQ(json["groups"][0]["n"], 2);
}

TEST_F(CampaignVerb, PrintsOnlyKeysThatTheDocumentNames) {
  for (const std::string summary : {"detections", "reactions"}) {
    place.replace("campaigns/few.yaml", "runs: 2", "runs: 1\nsummary: " + summary);
    const auto json = nlohmann::json::parse(campaign({"--json", "--fresh"}).out);
    EXPECT_EQ(json["groups"].size(), 1U);
    EXPECT_THAT(test::undocumented_keys(json, "Campaign file"), IsEmpty());
    place.replace("campaigns/few.yaml", "runs: 1\nsummary: " + summary, "runs: 2");
  }
}

TEST_F(CampaignVerb, SweepsAKey) {
  const auto json = nlohmann::json::parse(
      campaign({"--json", "--set", "control.contact_detector.reaction_force_N=8,12", "--runs", "1"}).out);
  ASSERT_EQ(json["groups"].size(), 2U);
  EXPECT_EQ(json["groups"][0]["at"]["control.contact_detector.reaction_force_N"], "8");
  EXPECT_LT(json["groups"][0]["median_ms"], json["groups"][1]["median_ms"]) << "a lower threshold is earlier";
}

TEST_F(CampaignVerb, RepeatsOneRunWithRecordingAndPage) {
  const Outcome outcome = campaign({"--run", "1"});
  EXPECT_THAT(outcome.out, HasSubstr("verdict"));
  EXPECT_FALSE(test::bytes_of(place / "out/run.h5").empty());
  EXPECT_FALSE(test::bytes_of(place / "out/report.html").empty());
  const Outcome replayed =
      flinch({"run", place.at("out/run.h5"), "--station", "recorded", "--out", place.at("again")});
  EXPECT_THAT(replayed.err, HasSubstr("bit for bit"));
}

/// With other options the run of that number is another than that of the table.
TEST_F(CampaignVerb, RepeatsNoRunOfAnotherCampaignThanThatOfTheTable) {
  campaign({"--set", "pylon.stiffness_N_per_m=5000,50000"});
  const Outcome other = campaign({"--run", "1"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("results.part: holds the results of another campaign, or of other"));
  EXPECT_FALSE(std::filesystem::exists(place / "out/run.h5"));
  campaign({"--set", "pylon.stiffness_N_per_m=5000,50000", "--run", "1"});
  EXPECT_TRUE(std::filesystem::exists(place / "out/run.h5"));
}

TEST_F(CampaignVerb, RefusesTheResultsOfAnotherCampaignUnlessToldToBeginAnew) {
  campaign({});
  const Outcome other = campaign({"--seed", "2"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("--fresh"));
  EXPECT_EQ(campaign({"--seed", "2", "--fresh"}).status, 0);
}

TEST_F(CampaignVerb, TellsAKeyThatNobodyKnowsBeforeItWritesAnything) {
  const auto before = place.contents();
  const Outcome outcome = campaign({"--set", "control.contact_detector.reacton_force_N=8"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'reaction_force_N'?"));
  EXPECT_TRUE(place.contents() == before);
}

TEST_F(CampaignVerb, TellsWhichRunsThereAre) {
  const Outcome outcome = campaign({"--run", "2"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the runs 0 to 1"));
}

}  // namespace
}  // namespace flinch
