#include "experiments/verdict/verdict_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/verdict/verdict.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A contact that was detected after 12.3 ms and never ended.
Verdict verdict_with_contact() {
  ContactVerdict contact;
  contact.body = "platform";
  contact.onset = 0.5;
  contact.detected = 0.5123;
  contact.speed = 0.52;
  contact.peak_force = 100.4;
  contact.limit = 280.0;
  contact.limit_name = "transient";
  contact.within_limit = true;
  Verdict verdict;
  verdict.contacts.push_back(contact);
  verdict.simulated = 1.2;
  return verdict;
}

TEST(VerdictTable, TellsEveryContactAndWhyTheVerdictIsBad) {
  Verdict verdict = verdict_with_contact();
  EXPECT_THAT(verdict_table(verdict, {.wall = 0.5, .seed = 7}),
              ::testing::AllOf(HasSubstr("12.3"), HasSubstr("never"), HasSubstr("verdict: good\n"),
                               HasSubstr("1.200 s in 0.50 s, seed 7")));
  verdict.remarks.push_back("it was not over");
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("verdict: good, but\n  - it was not over\n"));
  verdict.failures.push_back("it fell over");
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("verdict: bad\n  - it fell over\n  - it was not over\n"));
}

TEST(VerdictTable, SaysNothingOfContactsThatNobodyCouldSee) {
  Verdict verdict;
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("nothing was touched"));
  verdict.witness = Witness::none;
  verdict.detections = {0.25};
  EXPECT_THAT(verdict_table(verdict, {}),
              ::testing::AllOf(HasSubstr("detected at: 0.250 s"), Not(HasSubstr("nothing was touched"))));
}

TEST(VerdictTable, TellsWhetherTheRobotCouldStopWithinItsLimits) {
  Verdict verdict = verdict_with_contact();
  EXPECT_THAT(verdict_table(verdict, {}), Not(HasSubstr("the limits that it keeps")));
  EXPECT_THAT(verdict_json(verdict, {}), HasSubstr(R"("could_stop_within_limits":null,"stop_ms":null)"));
  verdict.contacts[0].could_stop = true;
  verdict.contacts[0].stop_duration = 0.043;
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("could stop within the limits that it keeps, in 43 ms"));
  EXPECT_THAT(verdict_json(verdict, {}), HasSubstr(R"("could_stop_within_limits":true,"stop_ms":43.0)"));
  verdict.contacts[0].could_stop = false;
  verdict.contacts[0].stop_duration.reset();
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("could not stop straight"));
  EXPECT_THAT(verdict_json(verdict, {}), HasSubstr(R"("could_stop_within_limits":false,"stop_ms":null)"));
}

TEST(VerdictOutput, TellsWhetherSeveralThingsTouchedTheRobot) {
  Verdict verdict = verdict_with_contact();
  const std::string sentence = "; no single contact explains the wrench\n";
  EXPECT_THAT(verdict_json(verdict, {}), HasSubstr(R"("several_contacts":null)"));
  for (const bool several : {true, false}) {
    verdict.contacts[0].several_contacts = several;
    EXPECT_EQ(nlohmann::json::parse(verdict_json(verdict, {}))["contacts"][0]["several_contacts"], several);
    const auto told = several ? ::testing::Matcher<std::string>(HasSubstr(sentence))
                              : ::testing::Matcher<std::string>(Not(HasSubstr(sentence)));
    EXPECT_THAT(verdict_table(verdict, {}), told);
  }
  verdict.contacts[0].several_contacts = true;
  verdict.contacts[0].classified = "platform";
  verdict.contacts[0].classified_at = 0.513;
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("with probability 0.000" + sentence))
      << "what it said first";
}

TEST(VerdictOutput, TellsWhatTheReactionDid) {
  Verdict verdict = verdict_with_contact();
  EXPECT_THAT(verdict_json(verdict, {}), HasSubstr(R"("reaction_tasks":[])"));
  verdict.contacts[0].reaction_tasks = {{{true, ReactionKind::retreat, -1}, 0.525},
                                        {{true, ReactionKind::opening, 1}, 0.75}};
  EXPECT_THAT(verdict_table(verdict, {}),
              ::testing::AllOf(
                  HasSubstr("  after 25.0 ms it goes back the way it came, class or direction not known\n"),
                  HasSubstr("  after 250.0 ms it opens leg 2\n")));
  const auto tasks = nlohmann::json::parse(verdict_json(verdict, {}))["contacts"][0]["reaction_tasks"];
  ASSERT_EQ(tasks.size(), 2U);
  EXPECT_EQ(tasks[0]["task"], "retreat");
  EXPECT_TRUE(tasks[0]["leg"].is_null());
  EXPECT_NEAR(tasks[0]["ms"].get<double>(), 25.0, 1e-9);
  EXPECT_EQ(tasks[1]["task"], "opening");
  EXPECT_EQ(tasks[1]["leg"], 2);
}

TEST(VerdictOutput, TellsByWhichLimitsAndForHowLongAForceWasAboveThem) {
  Verdict verdict = verdict_with_contact();
  verdict.limits = {.region = "lower_leg",
                    .transient = 100.0,
                    .quasi_static = 130.0,
                    .transient_source = "set by the scenario",
                    .quasi_static_source = "a table"};
  verdict.contacts[0].limit = 100.0;
  verdict.contacts[0].over_limit = 0.012;
  verdict.contacts[0].within_limit = false;
  const std::string table = verdict_table(verdict, {});
  EXPECT_THAT(table, HasSubstr("     100      100  transient          12  NO\n"));
  EXPECT_THAT(table, HasSubstr("force limits       lower leg\n"
                               "  transient        100 N, set by the scenario\n"
                               "  quasi-static     130 N after 500 ms, a table\n"));
  const auto json = nlohmann::json::parse(verdict_json(verdict, {}));
  EXPECT_EQ(json["force_limits"], nlohmann::json({{"region", "lower_leg"},
                                                  {"transient_N", 100.0},
                                                  {"transient_source", "set by the scenario"},
                                                  {"quasi_static_N", 130.0},
                                                  {"quasi_static_source", "a table"},
                                                  {"transient_duration_ms", 500.0}}));
  EXPECT_THAT(verdict_table(Verdict(), {}), Not(HasSubstr("force limits"))) << "nothing was judged";
}

TEST(VerdictJson, IsOneLineThatHoldsTheTable) {
  const std::string text = verdict_json(verdict_with_contact(), {.wall = 0.5, .seed = 7});
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["verdict"], "good");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_NEAR(json["contacts"][0]["detection_ms"].get<double>(), 12.3, 1e-9);
  EXPECT_TRUE(json["contacts"][0]["removal_ms"].is_null());
  EXPECT_TRUE(json["imu_doubt"].is_null());
  EXPECT_TRUE(json["passive_encoders_lost_s"].is_null());
}

TEST(VerdictJson, TellsSinceWhenThereWereNoPassiveEncoders) {
  Verdict verdict;
  verdict.passive_lost = 0.25;
  EXPECT_EQ(nlohmann::json::parse(verdict_json(verdict, {}))["passive_encoders_lost_s"], 0.25);
}

TEST(AReturn, IsToldInTableAndJson) {
  Verdict verdict;
  EXPECT_TRUE(nlohmann::json::parse(verdict_json(verdict, {}))["returned"].is_null());
  EXPECT_THAT(verdict_table(verdict, {}), Not(HasSubstr("reset")));
  verdict.returned = {.reset = 1.5,
                      .from = "stopped",
                      .stopped_by = "a leg is nearly stretched or folded",
                      .resumed = 4.0,
                      .resets = 2,
                      .reactions = 1,
                      .recovery_speed = 0.05,
                      .nominal_speed = 0.2};
  EXPECT_THAT(
      verdict_table(verdict, {}),
      HasSubstr("reset from stopped at 1.500 s, where the gate had closed: a leg is nearly stretched or "
                "folded\n  nominal motion   at 4.000 s, 2.50 s later; 2 resets, 1 new reaction\n"
                "  on the way       at most 0.050 m/s recovering, 0.200 m/s nominal\n"));
  EXPECT_EQ(nlohmann::json::parse(verdict_json(verdict, {}))["returned"],
            nlohmann::json({{"from", "stopped"},
                            {"stopped_by", "a leg is nearly stretched or folded"},
                            {"reset_s", 1.5},
                            {"resumed_s", 4.0},
                            {"resets", 2},
                            {"reactions", 1},
                            {"recovery_speed_m_per_s", 0.05},
                            {"nominal_speed_m_per_s", 0.2},
                            {"fault", ""}}));
  verdict.returned->resumed.reset();
  EXPECT_THAT(verdict_table(verdict, {}), HasSubstr("nominal motion   never again"));
  EXPECT_TRUE(nlohmann::json::parse(verdict_json(verdict, {}))["returned"]["resumed_s"].is_null());
}

TEST(VerdictJson, TellsSinceWhenTheImuWasLeftOut) {
  Verdict verdict;
  verdict.imu_doubt = ImuFault::frozen;
  verdict.imu_doubted = 0.5;
  const auto json = nlohmann::json::parse(verdict_json(verdict, {}));
  EXPECT_EQ(json["imu_doubt"]["kind"], "frozen");
  EXPECT_EQ(json["imu_doubt"]["since_s"], 0.5);
}

}  // namespace
}  // namespace flinch
