// Two lies at once and in the wrong moment: at rest, before a motion, in a stop, in a contact, in its
// reaction. FLINCH_LIE_PAIRS says how many; without it 40.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/fault/lies/lie_cases.h"
#include "tests/support/wanted.h"

namespace flinch::test {
namespace {

class PairsOfLies : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Robots, PairsOfLies, testing::Values("planar_3rrr", "five_bar", "hexapod_6ups"),
                         [](const auto& robot) { return std::string(robot.param); });

TEST_P(PairsOfLies, AreAnsweredInTheWrongMomentToo) {
  const auto count = test::wanted<std::size_t>("FLINCH_LIE_PAIRS", 40);
  const std::vector<LieCase> cases = pairs_of_lies(count, 1, GetParam());
  const std::vector<LieOutcome> outcomes = try_all(cases);
  fmt::print("{}", table_head());
  int excused = 0;
  LieOutcome worst;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const LieOutcome& outcome = outcomes[i];
    const std::string problem = problem_with(outcome);
    const std::string reason = problem.empty() ? "" : reason_of_failure(cases[i]);
    worst.excess = std::max(worst.excess, outcome.excess);
    worst.force = std::max(worst.force, outcome.force);
    if (!problem.empty() || outcome.force > 1.2) fmt::print("{}  {} {}\n", line_of(outcome), problem, reason);
    excused += reason.empty() ? 0 : 1;
    EXPECT_TRUE(outcome.began) << "the gate was not open: " << line_of(outcome);
    if (reason.empty()) {
      EXPECT_EQ(problem, "") << line_of(outcome);
    } else {
      EXPECT_LT(outcome.excess, cases[i].scene.robot == "planar_3rrr" ? 1.5 : 3.0) << line_of(outcome);
    }
  }
  fmt::print(
      "{} pairs, {} beyond a bound with a reason; at most {:.2f} m/s above the honest run, {:.2f} of its "
      "force\n",
      outcomes.size(), excused, worst.excess, worst.force);
}

}  // namespace
}  // namespace flinch::test
