// Verbs that are killed at random moments, into a folder that holds an older result. What is there afterwards
// is the older result or the new one, whole; what the dead have left goes with the next call. 10 kills of
// each verb; FLINCH_KILLS in the environment says how many instead.
#include <gtest/gtest.h>

#include <iostream>

#include "systems/framework/random.h"
#include "tests/campaign/interrupted/verb_results.h"
#include "tests/support/flinch_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::InterruptedVerb;
using test::OtherProgram;
using test::VerbResults;

int wanted_kills() { return test::wanted("FLINCH_KILLS", 10); }

class KilledVerbs : public testing::Test {
 protected:
  /// Kills the verb once. Whether it still ran.
  bool kill(const InterruptedVerb& verb) {
    OtherProgram program(test::flinch_program(verb.newer));
    const auto takes = static_cast<double>(results_.takes().count());
    const std::optional<int> status =
        program.wait(Time(static_cast<Time::rep>(random_.uniform(0.0, 1.05) * takes)));
    program.kill();
    EXPECT_EQ(status.value_or(0), 0) << program.output();
    results_.expect_one_of_both();
    return !status;
  }

  void kill_at_random_moments(const InterruptedVerb& verb) {
    results_.make_both(verb);
    const int kills = wanted_kills();
    int killed = 0;
    std::size_t left = 0;
    for (int call = 1; killed < kills && call < 10 * kills && !HasFailure(); ++call) {
      killed += kill(verb) ? 1 : 0;
      left += results_.leftovers();
      if (call % 5 == 0) results_.make_older(verb);
    }
    EXPECT_EQ(killed, kills);
    results_.make_older(verb);
    std::cout << killed << " kills of a program that takes " << 1e3 * to_seconds(results_.takes()) << " ms; "
              << left << " files lay there besides until the next call" << std::endl;
  }

  test::TemporaryFolder folder_;
  VerbResults results_{folder_.path()};
  RandomGenerator random_{3};
};

TEST_F(KilledVerbs, RunLeavesTheOlderRecordingOrTheNewOne) { kill_at_random_moments(results_.run()); }
TEST_F(KilledVerbs, CampaignLeavesTheOlderTableOrTheNewOne) { kill_at_random_moments(results_.campaign()); }
TEST_F(KilledVerbs, CalibrateLeavesTheOlderThresholdsOrTheNewOnes) {
  kill_at_random_moments(results_.calibrate());
}

}  // namespace
}  // namespace flinch
