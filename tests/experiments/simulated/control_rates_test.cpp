// The square and the contacts of [SafePR] Table IV with control periods from 0.25 to 4 ms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "experiments/recorded/replay.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SimulatedScenario scenario_at(const std::string& name, Time period, std::vector<std::string> set = {}) {
  set.push_back("control_period_us=" + std::to_string(period / 1us));
  return read_simulated_scenario(test::shipped("scenarios/" + name + ".yaml"), set);
}

double detection_time(const Verdict& verdict) {
  if (verdict.contacts.empty()) return INFINITY;
  return verdict.contacts.front().detected.value_or(INFINITY) - verdict.contacts.front().onset;
}

class ControlRate : public testing::TestWithParam<int> {
 protected:
  Time period() const { return std::chrono::microseconds(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Periods, ControlRate, testing::Values(250, 500, 2000, 4000),
                         [](const auto& period) { return std::to_string(period.param) + "us"; });

TEST_P(ControlRate, FindsNothingOnTheSquare) {
  const Verdict verdict = judge_experiment(scenario_at("square", period()));
  EXPECT_TRUE(verdict.good()) << verdict.failures.front();
  EXPECT_THAT(verdict.contacts, IsEmpty());
}

/// Of a shipped scenario at 1 kHz, run once.
double usual_detection_time(const std::string& name) {
  static std::map<std::string, double> known;
  const auto [found, is_new] = known.emplace(name, 0.0);
  if (is_new) found->second = detection_time(judge_experiment(scenario_at(name, 1ms)));
  return found->second;
}

TEST_P(ControlRate, DetectsThePublishedContactsAsSoonAsAKilohertz) {
  for (const char* const name :
       {"platform_collision", "first_link_collision", "second_link_collision", "clamping"}) {
    const double usual = usual_detection_time(name);
    SimulatedScenario scenario = scenario_at(name, period());
    scenario.expected.detection_time = 1.1 * usual + to_seconds(period());
    const Verdict verdict = judge_experiment(scenario);
    std::printf("  %-22s %4d us: detected after %6.2f ms, at 1 kHz %6.2f ms\n", name, GetParam(),
                1e3 * detection_time(verdict), 1e3 * usual);
    EXPECT_TRUE(verdict.good()) << name << ": " << verdict.failures.front();
    EXPECT_LE(detection_time(verdict), scenario.expected.detection_time) << name;
  }
}

TEST(ControlPeriod, OfTheScenarioCountsBeforeThatOfTheRobot) {
  const SimulatedScenario scenario = scenario_at("platform_collision", 2ms, {"duration_s=0.1"});
  EXPECT_EQ(scenario.robot.control_period, 1ms);
  EXPECT_EQ(scenario.control_period, 2ms);
  EXPECT_EQ(run_experiment(scenario).period, 2ms);
}

TEST(ControlPeriod, OfARecordingIsThatOfItsReplay) {
  const SimulatedScenario scenario = scenario_at("platform_collision", 2ms, {"duration_s=0.5"});
  const Recording recording = run_experiment(scenario);
  EXPECT_THAT(replay(scenario, recording).differing, IsEmpty());
  EXPECT_THAT(
      test::problems_of([&] { replay(scenario_at("platform_collision", 1ms), recording); }),
      ElementsAre(AllOf(HasSubstr("its control period is 1000 us"), HasSubstr("control_period_us: 2000"))));
}

TEST(ControlPeriod, TooLongForAFilterIsToldWithTheLineOfTheFilter) {
  EXPECT_THAT(
      test::problems_of([] {
        scenario_at("platform_collision", 4ms, {"control.momentum_observer={gain_per_s: [20, 2000, 20]}"});
      }),
      ElementsAre(
          AllOf(HasSubstr("control.momentum_observer"), HasSubstr("with a control period of 4000 us"))));
}

// ---------------------------------------------------------------- sensors with a rate of their own

/// An inertial measurement unit of 1.6 kHz beside a loop of 500 Hz.
std::vector<std::string> with_fast_imu(std::vector<std::string> more = {}) {
  more.insert(more.end(), {"sensors={imu: {rate_Hz: 1600, before_tick_us: 100}}", "plant={realism: bench}"});
  return more;
}

TEST(FastImu, IsDeliveredWithItsNewestSampleAndStamp) {
  const Recording recording = run_experiment(scenario_at("square", 2ms, with_fast_imu({"duration_s=0.5"})));
  const auto stamps = recording.column("imu", "acquired");
  for (std::size_t k = 10; k < stamps.size(); ++k) {
    const double age = 1e-9 * (static_cast<double>(recording.time_ns[k]) - stamps[k]);
    EXPECT_GE(age, 3.5e-3 - 1e-9) << k;
    EXPECT_LT(age, 3.5e-3 + 1.0 / 1600.0 + 1e-9) << "a newer one had come, " << k;
  }
}

TEST(FastImu, IsBelievedWhileItIsHonestAndNamedWhenItRepeatsItself) {
  const Recording honest =
      run_experiment(scenario_at("square_realistic", 2ms, with_fast_imu({"duration_s=2"})));
  for (const double doubt : honest.column("plausibility", "imu_doubt")) ASSERT_EQ(doubt, 0.0);
  const Recording frozen = run_experiment(
      scenario_at("square_realistic", 2ms,
                  with_fast_imu({"duration_s=2", "faults=[{signal: imu, kind: stuck, time_s: 1}]"})));
  const auto warnings = frozen.column("plausibility", "imu_doubt");
  const auto first =
      std::find_if(warnings.begin(), warnings.end(), [](double doubt) { return doubt != 0.0; });
  ASSERT_NE(first, warnings.end());
  const auto tick = static_cast<std::size_t>(first - warnings.begin());
  EXPECT_GE(frozen.time_ns[tick], 1'000'000'000);
  EXPECT_LE(frozen.time_ns[tick], 1'020'000'000);
  EXPECT_EQ(*first, static_cast<double>(ImuFault::frozen));
}

}  // namespace
}  // namespace flinch
