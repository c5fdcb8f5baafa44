// Twenty failures of the inertial measurement unit of each kind, in motion and before contacts.
// FLINCH_IMU_FAILURES says how many instead, docs/faults.md cites 50; FLINCH_IMU_SEED draws others.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/fault/imu/imu_trial.h"
#include "tests/support/wanted.h"

namespace flinch::test {
namespace {

/// Those of which some detector took the failure for a contact.
std::size_t false_contacts(const std::vector<ImuOutcome>& outcomes) {
  std::size_t count = 0;
  for (const ImuOutcome& each : outcomes) {
    for (const std::string& detector : each.false_contacts)
      fmt::print("  false: {} by {}\n", each.told, detector);
    count += each.false_contacts.empty() ? 0 : 1;
  }
  return count;
}

class ImuFailures : public testing::TestWithParam<ImuFailure> {};

std::string word_of(const ImuFailure& failure) {
  std::string word = failure.kind;
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

INSTANTIATE_TEST_SUITE_P(Every, ImuFailures, testing::ValuesIn(imu_failures()),
                         [](const auto& failure) { return word_of(failure.param); });

/// Nothing stops and no contact is missed. A unit that is late or turned is known by motion alone: until
/// there is enough of it, a few are taken for a contact.
TEST_P(ImuFailures, AreNamedStopNothingAndHideNoContact) {
  const auto count = test::wanted<std::size_t>("FLINCH_IMU_FAILURES", 20);
  const auto moving = try_failures(GetParam(), count, fail_in_motion);
  const auto touched = try_failures(GetParam(), count, fail_before_contact);
  fmt::print("{}{}", table_of_failures_head(), line_of(GetParam(), moving, touched));
  for (const auto* outcomes : {&moving, &touched}) {
    for (const ImuOutcome& each : *outcomes) {
      EXPECT_FALSE(each.stopped) << each.told;
      for (const std::string& name : each.missed) ADD_FAILURE() << each.told << " missed by " << name;
    }
  }
  if (GetParam().right == ImuFault::late) {
    const auto shown = static_cast<std::size_t>(std::count_if(
        moving.begin(), moving.end(), [](const auto& each) { return each.shown && *each.shown < 20ms; }));
    const std::size_t overdue = named_late_since_shown(moving);
    fmt::print("  {} err by 0.3 m/s^2 within 20 ms, {} of all take longer than 20 ms from there\n", shown,
               overdue);
    EXPECT_LE(overdue, count / 10);
  }
  const auto late = std::count_if(moving.begin(), moving.end(),
                                  [](const ImuOutcome& each) { return !each.named || *each.named > 20ms; });
  const bool needs_motion = GetParam().right == ImuFault::late || GetParam().right == ImuFault::turned;
  EXPECT_LE(static_cast<std::size_t>(late), needs_motion ? count / 2 : count / 20);
  const std::size_t allowed = GetParam().right == ImuFault::late ? count / 5 : count / 20;
  EXPECT_LE(false_contacts(moving) + false_contacts(touched), allowed);
}

class ImuFailuresWithJitter : public ImuFailures {};

INSTANTIATE_TEST_SUITE_P(Every, ImuFailuresWithJitter, testing::ValuesIn(imu_failures()),
                         [](const auto& failure) { return word_of(failure.param); });

/// Delays between 3 and 4 ms, and stamps that take them for 3.5.
TEST_P(ImuFailuresWithJitter, AreNamedAndStopNothing) {
  const auto count = test::wanted<std::size_t>("FLINCH_IMU_FAILURES", 10);
  const auto moving = try_failures(GetParam(), count, fail_in_motion, 1ms);
  const auto touched = try_failures(GetParam(), count, fail_before_contact, 1ms);
  fmt::print("{}{}", table_of_failures_head(), line_of(GetParam(), moving, touched));
  for (const auto* outcomes : {&moving, &touched}) {
    for (const ImuOutcome& each : *outcomes) EXPECT_FALSE(each.stopped) << each.told;
  }
  const auto late = std::count_if(moving.begin(), moving.end(),
                                  [](const ImuOutcome& each) { return !each.named || *each.named > 20ms; });
  const bool needs_motion = GetParam().right == ImuFault::late || GetParam().right == ImuFault::turned;
  EXPECT_LE(static_cast<std::size_t>(late), needs_motion ? count / 2 : count / 10);
  fmt::print("  {} of {} with a false contact\n", false_contacts(moving) + false_contacts(touched),
             2 * count);
}

TEST(HonestUnits, AreNotDoubtedForTheirJitter) {
  const auto count = test::wanted<std::size_t>("FLINCH_IMU_FAILURES", 20);
  int doubted = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const ImuFault doubt = doubt_of_honest_unit(i, 1ms);
    if (doubt == ImuFault::none) continue;
    fmt::print("  {}: {}\n", i, name(doubt));
    ++doubted;
  }
  fmt::print("doubted {} of {} in 2.5 s of motion each\n", doubted, count);
  EXPECT_EQ(doubted, 0);
}

}  // namespace
}  // namespace flinch::test
