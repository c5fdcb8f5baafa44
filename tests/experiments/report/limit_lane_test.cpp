#include "experiments/report/limit_lane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "systems/robot/motion_barriers.h"
#include "tests/experiments/report/lane_states.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint32_t bit_of(BarrierKind kind) { return 1U << static_cast<unsigned>(kind); }

Report shown(const Recording& recording, std::size_t together = 1) {
  return page_of(recording, &LimitLane::drop_unless_kept, together);
}

TEST(LimitsInWords, NameEveryBitOfARecording) {
  EXPECT_EQ(limits_in_words(0), "");
  EXPECT_EQ(limits_in_words(bit_of(BarrierKind::self_collision)), "self-collision");
  EXPECT_EQ(limits_in_words(bit_of(BarrierKind::condition_number) | bit_of(BarrierKind::rotation) |
                            LimitStatus::drive_speed),
            "condition number, rotation and speed of a drive");
  for (int kind = 0; kind <= static_cast<int>(BarrierKind::drive_range); ++kind)
    EXPECT_NE(limits_in_words(1U << static_cast<unsigned>(kind)), "") << kind;
  EXPECT_EQ(limits_in_words(LimitStatus::platform_speed), "speed of the platform");
  EXPECT_EQ(limits_in_words(1U << 30U), "") << "of no version";
}

TEST(LimitLane, TellsWhichLimitsBindAndWhereTheyAskForMoreThanTheDrivesHave) {
  SyntheticRun run(6);
  for (int k = 1; k < 6; ++k) run.at(k).limits.keeping = run.at(k).limits.valid = true;
  run.at(2).limits.binding = bit_of(BarrierKind::self_collision);
  run.at(3).limits.binding = bit_of(BarrierKind::self_collision) | bit_of(BarrierKind::distance);
  run.at(4).limits.binding = bit_of(BarrierKind::self_collision);
  run.at(4).limits.slack = 0.02;
  run.at(5).limits.valid = false;
  EXPECT_THAT(told(shown(run.recording())),
              ElementsAre("not kept", "kept", "self-collision", "self-collision and distance",
                          "self-collision, more than the drives have", "could not be kept"));
}

TEST(LimitLane, TakesWhatTheSolverLeavesForNoSlack) {
  SyntheticRun run(1);
  run.at(0).limits = {.keeping = true, .valid = true, .binding = 1, .slack = 1e-9};
  EXPECT_THAT(told(shown(run.recording())), ElementsAre("condition number"));
}

TEST(LimitLane, LosesNoLimitWhereSeveralSamplesAreShownAsOne) {
  SyntheticRun run(6);
  for (int k = 1; k < 6; ++k) run.at(k).limits.keeping = run.at(k).limits.valid = true;
  run.at(2).limits.binding = run.at(4).limits.binding = run.at(5).limits.binding = 1;
  run.at(4).limits.slack = 0.02;
  EXPECT_THAT(told(shown(run.recording(), 3)),
              ElementsAre("condition number", "condition number, more than the drives have"));
}

TEST(LimitLane, IsNoneWhereNobodyKeptLimitsOrToldOfThem) {
  EXPECT_THAT(shown(SyntheticRun(3).recording()).lanes, IsEmpty());
  Recording older = SyntheticRun(3).recording();
  std::erase_if(older.signals, [](const Signal& signal) { return signal.path == "limits"; });
  EXPECT_THAT(shown(older).lanes, IsEmpty());
}

}  // namespace
}  // namespace flinch::test
