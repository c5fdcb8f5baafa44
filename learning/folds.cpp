#include "learning/folds.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"

namespace flinch {

std::vector<int> folds_of_groups(const std::vector<int>& groups, int folds, std::uint64_t seed,
                                 const std::string& what) {
  std::vector<int> each(groups);
  std::sort(each.begin(), each.end());
  each.erase(std::unique(each.begin(), each.end()), each.end());
  if (each.size() < static_cast<std::size_t>(folds)) {
    throw SetupError(fmt::format("there are {} {} to learn from; {} folds need at least as many", each.size(),
                                 what, folds));
  }
  RandomGenerator random(derive_seed(seed, "folds"));
  std::vector<std::size_t> place(each.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  for (std::size_t i = place.size(); i > 1; --i) std::swap(place[i - 1], place[random() % i]);
  std::vector<int> fold;
  for (const int group : groups) {
    const auto found = std::lower_bound(each.begin(), each.end(), group) - each.begin();
    fold.push_back(
        static_cast<int>(place[static_cast<std::size_t>(found)] % static_cast<std::size_t>(folds)));
  }
  return fold;
}

}  // namespace flinch
