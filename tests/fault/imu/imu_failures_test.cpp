// What a robot of the rig makes of an inertial measurement unit that fails: a slice of the campaign.
#include <gtest/gtest.h>

#include "tests/fault/imu/imu_trial.h"

namespace flinch::test {
namespace {

TEST(ImuFailures, OfThreeKindsAreNamedInMotionAndBeforeAContact) {
  for (const ImuFailure& failure : imu_failures()) {
    const bool is_tried =
        failure.kind == "frozen" || failure.kind == "accelerometer off" || failure.kind == "tenfold noise";
    if (!is_tried) continue;
    const ImuOutcome moving = fail_in_motion(failure, 2);
    ASSERT_TRUE(moving.named.has_value()) << moving.told;
    EXPECT_LE(*moving.named, 20ms) << moving.told;
    EXPECT_STREQ(name(moving.doubt), name(failure.right)) << moving.told;
    const ImuOutcome touched = fail_before_contact(failure, 2);
    EXPECT_GT(touched.contacts, 0) << "detectors that notice the contact with the unit as it is";
    EXPECT_TRUE(touched.missed.empty()) << touched.told;
    for (const ImuOutcome& outcome : {moving, touched}) {
      EXPECT_TRUE(outcome.false_contacts.empty()) << outcome.told;
      EXPECT_FALSE(outcome.stopped) << outcome.told;
    }
  }
}

TEST(ImuStamps, ThatErrByHalfAMillisecondMakeNoHonestUnitDoubted) {
  for (std::size_t number = 0; number < 6; ++number)
    EXPECT_STREQ(name(doubt_of_honest_unit(number, 1ms)), name(ImuFault::none)) << number;
}

TEST(ImuStamps, ThatErrHideNoFailure) {
  for (const ImuFailure& failure : imu_failures()) {
    if (failure.kind != "accelerometer off" && failure.kind != "frozen") continue;
    const ImuOutcome moving = fail_in_motion(failure, 2, 1ms);
    ASSERT_TRUE(moving.named.has_value()) << moving.told;
    EXPECT_LE(*moving.named, 20ms) << moving.told;
    EXPECT_STREQ(name(moving.doubt), name(failure.right)) << moving.told;
  }
}

}  // namespace
}  // namespace flinch::test
