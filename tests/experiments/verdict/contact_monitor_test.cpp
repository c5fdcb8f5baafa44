#include "experiments/verdict/contact_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/verdict/verdict.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch::test {
namespace {

constexpr ConfigurationSpace planar = ConfigurationSpace::Kind::planar_pose;

Verdict judged(const SyntheticRun& run) { return judge(run.recording(), planar, {}, {}); }

/// Touched at 100 ms and 400 ms, detected 10 ms later.
SyntheticRun touched_twice() {
  SyntheticRun run(700);
  run.touch(BodyId::platform(), 100, 150, 50.0).touch(BodyId::platform(), 400, 450, 50.0);
  run.notice(110, 150).notice(410, 450);
  return run;
}

void judge_from(SyntheticRun& run, int tick, bool stays_inside) {
  for (int k = tick; k < 700; ++k)
    run.at(k).braking = {.valid = true, .judged = tick * 1ms, .stays_inside = stays_inside, .duration = 0.04};
}

TEST(ContactMonitor, TellsOfEachContactWhetherTheRobotCouldStopWhenItNoticed) {
  SyntheticRun run = touched_twice();
  judge_from(run, 110, true);
  judge_from(run, 410, false);
  const Verdict verdict = judged(run);
  ASSERT_EQ(verdict.contacts.size(), 2U);
  EXPECT_EQ(verdict.contacts[0].could_stop, true);
  EXPECT_EQ(verdict.contacts[0].stop_duration, 0.04);
  EXPECT_EQ(verdict.contacts[1].could_stop, false);
}

TEST(ContactMonitor, TakesNoOldAnswerForThatOfANewContact) {
  SyntheticRun run = touched_twice();
  judge_from(run, 110, true);
  const Verdict verdict = judged(run);
  EXPECT_EQ(verdict.contacts.at(0).could_stop, true);
  EXPECT_EQ(verdict.contacts.at(1).could_stop, std::nullopt);
}

TEST(ContactMonitor, KnowsNoDurationOfAStopThatIsNotPossible) {
  SyntheticRun run = touched_twice();
  for (int k = 110; k < 700; ++k) {
    run.at(k).braking.valid = true;
    run.at(k).braking.judged = 110ms;
  }
  const ContactVerdict contact = judged(run).contacts.at(0);
  EXPECT_EQ(contact.could_stop, false);
  EXPECT_EQ(contact.stop_duration, std::nullopt);
}

// From the detection on, and not of a place that is held: what led there was about another contact.
TEST(ContactMonitor, TellsOfEachContactWhichTasksTheReactionFollowed) {
  const FollowedTask braked{true, ReactionKind::brake, -1}, retreats{true, ReactionKind::retreat, -1};
  SyntheticRun run = touched_twice();
  for (int k = 110; k < 700; ++k) run.at(k).task = k < 112 ? braked : retreats;
  for (int k = 110; k < 700; ++k)
    run.at(k).reaction.mode = k >= 300 && k < 415 ? ReactionMode::hold : ReactionMode::react;
  const Verdict verdict = judged(run);
  const std::vector<TaskBegin>& first = verdict.contacts.at(0).reaction_tasks;
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0].task, braked);
  EXPECT_EQ(first[1].task, retreats);
  EXPECT_NEAR(first[1].time, 0.112, 1e-9);
  const std::vector<TaskBegin>& second = verdict.contacts.at(1).reaction_tasks;
  ASSERT_EQ(second.size(), 1U);
  EXPECT_NEAR(second[0].time, 0.415, 1e-9);
}

TEST(ContactMonitor, SaysNothingOfAStopThatNobodyJudged) {
  EXPECT_EQ(judged(touched_twice()).contacts.at(0).could_stop, std::nullopt);
}

// Detected since 90 ms, until 120 ms; the contact begins at 100 ms and is detected at 130 ms.
TEST(ContactMonitor, DoesNotTakeAnAlarmThatLastsFromBeforeForTheContact) {
  SyntheticRun run(400);
  run.touch(BodyId::platform(), 100, 200, 50.0).notice(90, 120);
  EXPECT_EQ(judged(run).contacts.at(0).detected, std::nullopt);
  run.notice(130, 200);
  const ContactVerdict contact = judged(run).contacts.at(0);
  EXPECT_NEAR(contact.detected.value_or(-1.0), 0.130, 1e-12);
  EXPECT_EQ(contact.detected_by.at(0).detected, contact.detected);
}

// The crate from 100 ms to 200 ms with 80 N; the hand from 120 ms to 300 ms with 30 N, so it is the weaker
// one at first and alone after that.
TEST(ContactMonitor, TellsTwoObstaclesThatTouchAtOnceApart) {
  SyntheticRun run(600);
  run.touch(BodyId::platform(), 100, 200, 80.0);
  for (int k = 100; k <= 200; ++k) run.at(k).contact.strongest.obstacle = 1;
  run.touch_too(BodyId::link2(0), 120, 300, -30.0).notice(130, 320);
  const Verdict verdict = judged(run);
  ASSERT_EQ(verdict.contacts.size(), 2U);
  const ContactVerdict &crate = verdict.contacts[0], &hand = verdict.contacts[1];
  EXPECT_EQ(crate.obstacle_name, "crate");
  EXPECT_EQ(crate.body, "platform");
  EXPECT_EQ(crate.peak_force, 80.0);
  EXPECT_NEAR(crate.onset, 0.099 + 0.001 / 80.0, 1e-12);
  EXPECT_NEAR(crate.removed.value_or(-1.0), 0.201, 1e-12);
  EXPECT_EQ(hand.obstacle_name, "hand");
  EXPECT_EQ(hand.body, "leg1_link2");
  EXPECT_EQ(hand.peak_force, 30.0);
  EXPECT_NEAR(hand.onset, 0.119 + 0.001 / 30.0, 1e-12);
  EXPECT_NEAR(hand.removed.value_or(-1.0), 0.301, 1e-12);
  EXPECT_NEAR(crate.detected.value_or(-1.0), 0.130, 1e-12) << "detected once, for both had begun";
  EXPECT_EQ(hand.detected, crate.detected);
}

TEST(ContactMonitor, TakesLinksOfALegThatTwoObstaclesTouchForNoClamping) {
  SyntheticRun run(600);
  run.touch(BodyId::link1(0), 100, 200, 80.0);
  for (int k = 100; k <= 200; ++k) run.at(k).contact.strongest.obstacle = 1;
  run.touch_too(BodyId::link2(0), 100, 200, -30.0).notice(130, 320);
  const Verdict verdict = judged(run);
  ASSERT_EQ(verdict.contacts.size(), 2U);
  EXPECT_EQ(verdict.contacts[0].body, "leg1_link1");
  EXPECT_EQ(verdict.contacts[1].body, "leg1_link2");
}

TEST(ContactMonitor, RemarksBodiesOfTheRobotThatTouchOneAnother) {
  SyntheticRun run(500);
  for (int k = 250; k < 260; ++k) {
    ContactTruth& contact = run.at(k).contact;
    contact.self_contact = true;
    contact.self_body = BodyId::link2(0).index();
    contact.self_other = BodyId::link2(1).index();
  }
  EXPECT_THAT(judged(run).remarks, ::testing::ElementsAre("leg1_link2 touched leg2_link2 from 0.250 s on"));
}

TEST(ContactMonitor, LetsAContactThatIsTakenForAnotherBeRemarked) {
  SyntheticRun run(500);
  run.touch(BodyId::platform(), 100, 150, 20.0).notice(110, 180).classify(112, BodyId::link2(0).index());
  EXPECT_TRUE(judged(run).good());
  EXPECT_THAT(judged(run).remarks,
              ::testing::ElementsAre(
                  "the contact with platform was taken for one with leg1_link2, with probability 0.970; see "
                  "control.isolation"));

  SyntheticRun right(500);
  right.touch(BodyId::platform(), 100, 150, 20.0).notice(110, 180).classify(112, BodyId::platform().index());
  EXPECT_THAT(judged(right).remarks, ::testing::IsEmpty());
}

/// From this tick on its classifier says how well one contact explains the wrench, and judges it.
void look_for_several(SyntheticRun& run, int first, bool several) {
  for (int k = first; k < 700; ++k) {
    ContactClassification& said = run.at(k).classification;
    said.valid = true;
    said.residual = several ? 16.0 : 1.0;
    said.several_contacts = several;
  }
}

TEST(ContactMonitor, TellsWhatTheRobotSaidLastOfSeveralContacts) {
  SyntheticRun run = touched_twice();
  look_for_several(run, 110, false);
  look_for_several(run, 112, true);
  look_for_several(run, 415, false);
  const Verdict verdict = judged(run);
  EXPECT_EQ(verdict.contacts.at(0).several_contacts, true);
  EXPECT_EQ(verdict.contacts.at(0).classified, "");
  EXPECT_EQ(verdict.contacts.at(1).several_contacts, false);
}

TEST(ContactMonitor, KnowsNothingOfSeveralContactsFromAClassifierThatDoesNotLook) {
  EXPECT_EQ(judged(touched_twice()).contacts.at(0).several_contacts, std::nullopt) << "that says nothing";
  SyntheticRun run = touched_twice();
  run.classify(112, BodyId::platform().index());
  EXPECT_EQ(judged(run).contacts.at(0).classified, "platform");
  EXPECT_EQ(judged(run).contacts.at(0).several_contacts, std::nullopt);
}

/// As recordings of versions before `residual` are.
TEST(ContactMonitor, ReadsClassificationsThatWereRecordedWithoutAResidual) {
  SyntheticRun run = touched_twice();
  look_for_several(run, 112, false);
  look_for_several(run, 412, true);
  Recording recording = run.recording();
  for (Signal& signal : recording.signals) {
    if (signal.path != "classification") continue;
    ASSERT_EQ(signal.layout.fields.back().name, "residual");
    signal.layout.fields.back().name = "unknown";
  }
  const Verdict verdict = judge(recording, planar, {}, {});
  EXPECT_EQ(verdict.contacts.at(0).several_contacts, std::nullopt) << "it may not have looked";
  EXPECT_EQ(verdict.contacts.at(1).several_contacts, true);
}

}  // namespace
}  // namespace flinch::test
