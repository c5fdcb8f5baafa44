// 50 runs, each killed at a random moment: see the tests of RecordingStream, which kill a few.
#include "tests/systems/framework/killed_run.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace flinch {
namespace {

class KilledRun : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(KilledRun, InRealTimeHoldsAllButTheLastSecond) {
  for (std::uint64_t round = 0; round < 5; ++round) {
    test::kill_runs(5, 100 + round, test::Pace::real_time, folder_.path());
  }
}

TEST_F(KilledRun, AsFastAsPossibleHoldsAllButTheLastSecond) {
  for (std::uint64_t round = 0; round < 5; ++round) {
    test::kill_runs(5, 200 + round, test::Pace::as_fast_as_possible, folder_.path());
  }
}

TEST_F(KilledRun, AtItsEndLeavesAWholeRecording) { test::kill_ends_of_runs(50, 300, folder_.path()); }

}  // namespace
}  // namespace flinch
