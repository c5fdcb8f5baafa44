#pragma once

#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "tests/fault/link/link_latency.h"

namespace flinch::test {

/// What a trial has measured.
struct Finding {
  std::string what;
  Latency latency;
};

/// What has come out of the trial of a fault.
struct TrialOutcome {
  std::vector<Finding> findings;
  std::string skipped = "";  ///< why there was no trial; empty where there was
};

/// One fault of the link or of the programs at its ends: what follows, how soon, and the trial that brings it
/// about with real programs and checks what follows.
struct LinkFault {
  const char* name;  ///< of its test
  const char* description;
  const char* reaction;
  int within;  ///< [ms] from the last good sample; 0: nothing happens that takes time
  TrialOutcome (*trial)();
};

std::span<const LinkFault> link_fault_table();

/// Its name.
inline std::ostream& operator<<(std::ostream& out, const LinkFault& fault) { return out << fault.name; }

}  // namespace flinch::test
