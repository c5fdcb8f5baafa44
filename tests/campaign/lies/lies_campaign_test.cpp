// The whole campaign of lies, and how near honest robots come to be called liars. FLINCH_LIES_SHARE says how
// much of it: 1 is all, some hours of one processor. Without it 0.02.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/fault/lies/false_alarms.h"
#include "tests/fault/lies/lie_cases.h"
#include "tests/support/wanted.h"

namespace flinch::test {
namespace {

std::size_t runs(std::size_t all) {
  return static_cast<std::size_t>(test::wanted("FLINCH_LIES_SHARE", 0.02) * static_cast<double>(all));
}

/// `count` of them, spread over all.
std::vector<LieCase> some_of(const std::vector<LieCase>& all, std::size_t count) {
  std::vector<LieCase> some;
  for (std::size_t i = 0; i < std::min(count, all.size()); ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

class Lies : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Robots, Lies, testing::Values("planar_3rrr", "five_bar", "hexapod_6ups"),
                         [](const auto& robot) { return std::string(robot.param); });

TEST_P(Lies, AreAllNamedOrCannotBe) {
  const std::string robot = GetParam();
  std::vector<LieCase> cases = robot == "planar_3rrr" ? all_lies() : all_lies_of(robot);
  cases = some_of(cases, runs(cases.size()));
  const std::vector<LieOutcome> outcomes = try_all(cases);
  fmt::print("{}", table_head());
  int unnamed = 0, excused = 0;
  LieOutcome worst;
  Time longest{};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const LieOutcome& outcome = outcomes[i];
    fmt::print("{}", line_of(outcome));
    const std::string problem = problem_with(outcome);
    const std::string reason = reason_of_failure(cases[i]);
    unnamed += outcome.named ? 0 : 1;
    EXPECT_TRUE(outcome.began) << "the gate was not open: " << line_of(outcome);
    if (!problem.empty() && !reason.empty()) {
      ++excused;
      fmt::print("  {}: {}\n", problem, reason);
      continue;
    }
    EXPECT_EQ(problem, "") << line_of(outcome);
    if (!outcome.named) continue;
    worst.excess = std::max(worst.excess, outcome.excess);
    worst.growth = std::max(worst.growth, outcome.growth);
    longest = std::max(longest, outcome.rest.value_or(1h));
  }
  fmt::print(
      "{} lies, {} never named, {} beyond a bound with a reason; of the named at most {:.2f} m/s above the "
      "honest "
      "run, {} ms until rest, {} ms of growing energy\n",
      outcomes.size(), unnamed, excused, worst.excess, longest / 1ms, worst.growth / 1ms);
}

class FalseAlarms : public testing::TestWithParam<MountedSensors> {};

INSTANTIATE_TEST_SUITE_P(Sensors, FalseAlarms,
                         testing::Values(MountedSensors{}, MountedSensors{.passive_encoders = false},
                                         MountedSensors{.imu = false},
                                         MountedSensors{.passive_encoders = false, .imu = false}),
                         [](const auto& mounted) {
                           return std::string(mounted.param.passive_encoders ? "With" : "Without") +
                                  "PassiveEncoders" + (mounted.param.imu ? "With" : "Without") + "Imu";
                         });

const std::string folder = FLINCH_SOURCE_DIR "/tests/campaign/lies/";

TEST_P(FalseAlarms, AreNoneInThreeHoursOfDynamicMotion) {
  const Margins margins = margins_of_campaign(folder + "motion.yaml", runs(310), GetParam());
  fmt::print("motion: {}", margins.table());
  EXPECT_TRUE(margins.alarms.empty());
}

TEST_P(FalseAlarms, AreNoneInThreeThousandContacts) {
  const Margins margins = margins_of_campaign(folder + "contacts.yaml", runs(3200), GetParam());
  fmt::print("contacts: {}", margins.table());
  EXPECT_TRUE(margins.alarms.empty());
}

struct OtherRun {
  const char* file;
  std::size_t runs;
  double share_of_alarms = 0.0;  ///< that is known, docs/faults.md
};

class FalseAlarmsOfOthers : public testing::TestWithParam<OtherRun> {};

INSTANTIATE_TEST_SUITE_P(Runs, FalseAlarmsOfOthers,
                         testing::Values(OtherRun{"contacts_moving", 3200, 0.01},
                                         OtherRun{"motion_five_bar", 310},
                                         OtherRun{"contacts_five_bar", 3200}, OtherRun{"motion_hexapod", 310},
                                         OtherRun{"contacts_hexapod", 3200}),
                         [](const auto& run) { return std::string(run.param.file); });

TEST_P(FalseAlarmsOfOthers, AreNone) {
  const Margins margins = margins_of_campaign(folder + GetParam().file + ".yaml",
                                              std::max<std::size_t>(1, runs(GetParam().runs) / 4), {});
  fmt::print("{}: {}", GetParam().file, margins.table());
  EXPECT_LE(margins.false_alarms(), GetParam().share_of_alarms * static_cast<double>(margins.runs));
}

}  // namespace
}  // namespace flinch::test
