// A slice of the campaign of lies at every rate: what is named at 1 kHz is named, up to 1 ms a tick as soon,
// and honest robots are not doubted. FLINCH_RATES_SHARE says how much of it: 1 is some minutes of one
// processor a rate.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/fault/lies/false_alarms.h"
#include "tests/fault/lies/lie_cases.h"
#include "tests/support/wanted.h"

namespace flinch::test {
namespace {

class Rate : public testing::TestWithParam<int> {
 protected:
  Time period() const { return std::chrono::microseconds(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Lies, Rate, testing::Values(250, 500, 2000, 4000),
                         [](const auto& period) { return std::to_string(period.param) + "us"; });

constexpr std::size_t robots = 3;  // drawn for each lie: when one is named depends on what it does just then

/// Lie by lie, each of so many robots.
std::vector<LieCase> cases_at(Time period) {
  std::vector<LieCase> cases;
  for (const char* const lie :
       {"encoder2:wrong:-0.02", "encoder2:drifting:-5", "encoder2:reversed", "encoder2:noise:1e-3",
        "current2:wrong:-2", "current2:reversed", "current2:scaled:0", "drive2:off", "drive2:stuck:50",
        "drive2:reversed", "drive2:scaled:-1", "encoders:reversed", "currents:stuck", "brakes:off",
        "passive_encoder2:wrong:0.0175"})
    for (unsigned seed = 1; seed <= robots; ++seed)
      cases.push_back({{.speed = 0.6, .seed = seed, .brakes = 5ms, .period = period}, lie});
  return cases;
}

/// What is told later at a rate than a tenth and its readings allow; of these the mean over all lies counts.
bool is_told_late(const std::string& lie, Time period) {
  return (lie == "current2:reversed" && period == 250us) || (lie == "encoder2:noise:1e-3" && period == 4ms);
}

/// Questions with rows of up to four readings take these, however long ticks are. The mean over robots
/// counts, since the time at which a lie is named depends on what the robot does just then.
TEST_P(Rate, NamesLiesAsSoonAsAKilohertzDoes) {
  const int readings = period() > 1ms ? 4 : 1;

  const std::vector<LieOutcome> usual = try_all(cases_at(1ms)), here = try_all(cases_at(period()));
  fmt::print("{}", table_head());
  const std::vector<LieCase> cases = cases_at(period());
  const auto latest = [&](Time at_usual, int named) {
    return at_usual + at_usual / 10 + named * readings * period();
  };
  Time at_usual{}, at_this{};
  int named = 0;
  for (std::size_t first = 0; first < usual.size(); first += robots) {
    Time of_usual{}, of_this{};
    int of_lie = 0;
    for (std::size_t i = first; i < first + robots; ++i) {
      fmt::print("{}{}", line_of(usual[i]), line_of(here[i]));
      EXPECT_EQ(problem_with(here[i]), "") << line_of(here[i]);
      if (!usual[i].alarm || !usual[i].named) continue;
      ASSERT_TRUE(here[i].alarm.has_value()) << line_of(here[i]);
      EXPECT_TRUE(here[i].named) << line_of(here[i]);
      of_usual += *usual[i].alarm;
      of_this += *here[i].alarm;
      ++of_lie;
    }
    if (!is_told_late(cases[first].lie, period())) {
      EXPECT_LE(of_this, latest(of_usual, of_lie)) << line_of(here[first]);
    }
    at_usual += of_usual;
    at_this += of_this;
    named += of_lie;
  }
  ASSERT_GT(named, 0);
  fmt::print("named after {:.1f} ms at 1 kHz, {:.1f} ms at this rate, means of {}\n",
             1e3 * to_seconds(at_usual) / named, 1e3 * to_seconds(at_this) / named, named);
  EXPECT_LE(at_this, latest(at_usual, named));
}

TEST_P(Rate, DoesNotDoubtTheHonest) {
  const double share = test::wanted("FLINCH_RATES_SHARE", 0.02);
  const std::string folder = FLINCH_SOURCE_DIR "/tests/campaign/lies/";
  for (const auto& [file, runs] : {std::pair("motion.yaml", 8.0), std::pair("contacts.yaml", 400.0)}) {
    const auto count = static_cast<std::size_t>(std::max(1.0, share * runs));
    const Margins margins = margins_of_campaign(folder + file, count, {}, period());
    fmt::print("{} at {} us: {}", file, GetParam(), margins.table());
    EXPECT_TRUE(margins.alarms.empty()) << file << ": " << margins.table();
    EXPECT_GT(margins.seconds, 1.0) << "the robots move";
  }
}

}  // namespace
}  // namespace flinch::test
