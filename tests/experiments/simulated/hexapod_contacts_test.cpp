// A few of the trials of tests/campaign/hexapod, which prints them all.
#include <gtest/gtest.h>

#include <vector>

#include "tests/experiments/simulated/hexapod_trials.h"

namespace flinch {
namespace {

TEST(HexapodContacts, AreNoneInAFreeMotion) {
  const Verdict verdict = test::outcome_of(test::with_free_motion(test::hexapod_trial(1), 1)).verdict;
  EXPECT_TRUE(verdict.good()) << verdict.failures.front();
  EXPECT_TRUE(verdict.detections.empty());
  EXPECT_GT(verdict.simulated, 1.0);
}

TEST(HexapodContacts, AreDetectedAndRemoved) {
  const SimulatedScenario trial = test::hexapod_trial(1);
  std::vector<double> detected;
  for (const test::PlatformContact& contact : test::draw_contacts(trial, 4, 1)) {
    const test::ContactOutcome got =
        test::outcome_of(test::with_contact(trial, contact, test::Stiffness::hand));
    EXPECT_TRUE(got.is_platform_alone);
    EXPECT_EQ(got.verdict.fault, "");
    EXPECT_EQ(got.verdict.false_detections, 0);
    EXPECT_GE(got.detected, got.detected_at_best);
    EXPECT_LE(got.removed, 100.0);
    detected.push_back(got.detected);
  }
  EXPECT_LE(test::median(detected), 13.0);
}

}  // namespace
}  // namespace flinch
