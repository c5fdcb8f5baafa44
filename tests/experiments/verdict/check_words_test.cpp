#include "experiments/verdict/check_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr CheckMask no_imu =
    all_checks & ~check_bit(PlausibilityCheck::gyroscope) & ~check_bit(PlausibilityCheck::accelerometer);

TEST(ChecksOff, AreNoneWhereAllCanBeAsked) { EXPECT_THAT(checks_off(all_checks, true), IsEmpty()); }

TEST(ChecksOff, NameWhatIsMissingAndTheFaultThatCannotFollow) {
  EXPECT_THAT(
      checks_off(no_imu, true),
      ElementsAre(AllOf(StartsWith("encoders against the IMU (fault 29): needs"), HasSubstr("an IMU"))));
  EXPECT_THAT(checks_off(all_checks & ~check_bit(PlausibilityCheck::parity), true),
              ElementsAre(HasSubstr("(fault 13): needs passive")));
  EXPECT_THAT(checks_off(0, false), AllOf(SizeIs(12), Each(HasSubstr(": needs "))));
}

TEST(ChecksOff, AreThoseThatCouldBeAskedAtNoTime) {
  constexpr ConfigurationSpace planar = ConfigurationSpace::Kind::planar_pose;
  test::SyntheticRun run(100);
  for (int k = 0; k < 100; ++k)
    run.at(k).plausibility.askable = k < 60 ? no_imu : all_checks & ~check_bit(PlausibilityCheck::parity);
  EXPECT_THAT(judge(run.recording(), planar, {}, {}).checks_off,
              ElementsAre(HasSubstr("control.drive_check")));
  for (int k = 0; k < 100; ++k) run.at(k).plausibility.askable = k < 60 ? no_imu : 0;
  const Verdict verdict = judge(run.recording(), planar, {}, {});
  EXPECT_EQ(verdict.checks_off, checks_off(no_imu, false));
  EXPECT_TRUE(verdict.good());
  EXPECT_THAT(verdict.remarks, IsEmpty());
}

TEST(ChecksOff, StandAboveEverythingElse) {
  Verdict verdict;
  EXPECT_THAT(verdict_table(verdict, {}), Not(HasSubstr("checks off")));
  EXPECT_THAT(verdict_json(verdict, {}), HasSubstr(R"("checks_off":[])"));
  verdict.checks_off = {"one (fault 1): needs this", "two (fault 2): needs that"};
  EXPECT_THAT(verdict_table(verdict, {}), StartsWith("checks off         one (fault 1): needs this\n"
                                                     "                   two (fault 2): needs that\n\n"));
  EXPECT_THAT(verdict_json(verdict, {}),
              HasSubstr(R"("checks_off":["one (fault 1): needs this","two (fault 2): needs that"])"));
}

}  // namespace
}  // namespace flinch
