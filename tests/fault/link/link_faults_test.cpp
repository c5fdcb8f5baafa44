#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "tests/fault/link/link_fault_table.h"
#include "tests/fault/link/link_trial.h"
#include "tests/support/machine_monitor.h"

namespace flinch {
namespace {

using test::LinkFault;

class LinkFaults : public testing::TestWithParam<LinkFault> {};

double milliseconds(Time time) { return 1e3 * to_seconds(time); }

bool is_evidence(const test::TrialOutcome& outcome) {
  return std::all_of(outcome.findings.begin(), outcome.findings.end(),
                     [](const test::Finding& finding) { return finding.latency.lateness <= 2ms; });
}

/// A trial on a machine that was not late, the third time at the latest.
test::TrialOutcome outcome_of(const LinkFault& fault) {
  for (int attempt = 0; attempt < 3; ++attempt) {
    test::TrialOutcome outcome = fault.trial();
    if (is_evidence(outcome)) return outcome;
    std::cout << "the machine was late" << std::endl;
  }
  throw test::TooBusy("the machine was late each time");
}

/// What happens only by the machine's lateness is not the program's: a little is allowed, and told. A machine
/// that stalls may not let a trial happen at all.
TEST_P(LinkFaults, HaveTheirReactionInTime) {
  const LinkFault& fault = GetParam();
  test::TrialOutcome outcome;
  try {
    outcome = outcome_of(fault);
  } catch (const test::TooBusy& busy) {
    if (test::machine_stall() < test::noticeable_stall) FAIL() << busy.what();
    GTEST_SKIP() << test::not_measured() << ": " << busy.what();
  }
  if (!outcome.skipped.empty()) GTEST_SKIP() << outcome.skipped;
  for (const auto& [what, latency] : outcome.findings) {
    std::cout << what << ": " << milliseconds(latency.value) << " ms, bound " << fault.within
              << " ms; the machine was late by " << milliseconds(latency.lateness) << " ms" << std::endl;
    if (fault.within == 0) continue;
    EXPECT_LE(latency.value, std::chrono::milliseconds(fault.within) + latency.lateness) << what;
  }
  EXPECT_EQ(outcome.findings.empty(), fault.within == 0) << "what is bounded is measured";
}

INSTANTIATE_TEST_SUITE_P(Table, LinkFaults, testing::ValuesIn(test::link_fault_table()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace flinch
