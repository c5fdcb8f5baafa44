#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace flinch {

struct Verdict;

/// What a summary says besides the verdict.
struct RunFacts {
  double wall = 0.0;  ///< time that the run took [s]
  std::uint64_t seed = 0;
  /// Where the simulated robot was drawn: what differs from its model, see robot_as_drawn().
  std::vector<std::pair<std::string, std::vector<double>>> robot{};
};

/// The verdict as a table for people.
std::string verdict_table(const Verdict& verdict, const RunFacts& facts);

/// The verdict as one JSON object on one line. Later versions add keys and rename none.
std::string verdict_json(const Verdict& verdict, const RunFacts& facts);

}  // namespace flinch
