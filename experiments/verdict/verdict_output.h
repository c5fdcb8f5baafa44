#pragma once

#include <cstdint>
#include <string>

namespace flinch {

struct Verdict;

/// What a summary says besides the verdict.
struct RunFacts {
  double wall = 0.0;  ///< time that the run took [s]
  std::uint64_t seed = 0;
};

/// The verdict as a table for people.
std::string verdict_table(const Verdict& verdict, const RunFacts& facts);

/// The verdict as one JSON object on one line. Later versions add keys and rename none.
std::string verdict_json(const Verdict& verdict, const RunFacts& facts);

}  // namespace flinch
