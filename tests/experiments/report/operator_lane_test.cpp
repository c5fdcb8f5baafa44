#include "experiments/report/operator_lane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/experiments/report/lane_states.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Report shown(const Recording& recording, std::size_t together = 1) {
  return page_of(recording, &OperatorLane::drop_unless_used, together);
}

/// A reset, a target that stays there, and a start.
SyntheticRun brought_back() {
  SyntheticRun run(6);
  run.at(1).pressed.reset = true;
  for (int k = 3; k < 6; ++k) run.at(k).target.number = 1;
  run.at(5).pressed.start = true;
  return run;
}

TEST(OperatorLane, TellsButtonsThatAreDownAndTargetsWhereTheyAreGiven) {
  EXPECT_THAT(told(shown(brought_back().recording())),
              ElementsAre("nothing", "reset", "nothing", "target", "nothing", "start"));
}

TEST(OperatorLane, LosesNothingWhereThePageShowsSeveralSamplesAsOne) {
  EXPECT_THAT(told(shown(brought_back().recording(), 3)), ElementsAre("reset", "start"));
}

TEST(OperatorLane, IsNotThereWhereNobodyDidAnything) {
  EXPECT_THAT(shown(SyntheticRun(3).recording()).lanes, IsEmpty());
  Recording older = SyntheticRun(3).recording();
  std::erase_if(older.signals,
                [](const Signal& signal) { return signal.path == "operator" || signal.path == "target"; });
  EXPECT_THAT(shown(older).lanes, IsEmpty());
}

}  // namespace
}  // namespace flinch::test
