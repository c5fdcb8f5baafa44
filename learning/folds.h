#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flinch {

/// The fold, 0 to `folds` - 1, of each entry of `groups`: groups are dealt out in an order that follows from
/// the seed, so none is in two folds, and no fold has two groups more than another. Throws SetupError where
/// there are fewer groups than folds; `what` they are called: "runs".
std::vector<int> folds_of_groups(const std::vector<int>& groups, int folds, std::uint64_t seed,
                                 const std::string& what);

}  // namespace flinch
