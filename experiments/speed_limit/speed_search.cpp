#include "experiments/speed_limit/speed_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace flinch {
namespace {

/// Speeds that grow by equal ratios, in whole mm/s.
class Ladder {
 public:
  explicit Ladder(const SpeedSearch& search)
      : search_(search),
        top_(static_cast<int>(
            std::ceil(std::log(search.fastest / search.slowest) / std::log1p(search.step) - 1e-9))) {}

  int top() const { return top_; }
  double operator[](int rung) const {
    if (rung == 0) return search_.slowest;
    if (rung == top_) return search_.fastest;
    const double share = static_cast<double>(rung) / top_;
    return std::round(1e3 * search_.slowest * std::pow(search_.fastest / search_.slowest, share)) / 1e3;
  }

 private:
  SpeedSearch search_;
  int top_;
};

struct Counts {
  std::size_t exceeded = 0, untested = 0;
};

/// The trials of a search, the hardest first: those that were not within at the last speed at which all were
/// tried, then those that came nearest to a limit.
class Trials {
 public:
  Trials(const SpeedSearch& search, const TrialAtSpeed& trial)
      : search_(search),
        order_(search.trials),
        used_(search.trials),
        deciding_(std::min(search.tolerated + 1, search.trials)),
        trial_(trial) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  bool are_within(const Counts& counts) const {
    return counts.exceeded <= search_.tolerated && counts.untested <= search_.spares;
  }

  /// All, until it is decided that they are not within.
  Counts all_at(double speed) {
    Counts counts;
    for (auto next = order_.begin(); next != order_.end() && are_within(counts); ++next) {
      const TrialResult result = trial_(*next, speed);
      used_[*next] = result.used;
      if (count(result, counts)) std::rotate(order_.begin(), next, next + 1);
    }
    if (!are_within(counts)) deciding_ = counts.exceeded + counts.untested;
    return counts;
  }

  /// Those alone that can decide, as they did the last time.
  Counts hardest_at(double speed) const {
    Counts counts;
    for (std::size_t place = 0; place < deciding_ && are_within(counts); ++place)
      count(trial_(order_[place], speed), counts);
    return counts;
  }

  void sort_by_use() {
    std::stable_sort(order_.begin(), order_.end(),
                     [this](std::size_t a, std::size_t b) { return used_[a] > used_[b]; });
  }

 private:
  /// Whether it was not within.
  static bool count(const TrialResult& result, Counts& counts) {
    if (result.ended == SpeedTrial::within) return false;
    ++(result.ended == SpeedTrial::exceeded ? counts.exceeded : counts.untested);
    return true;
  }

  SpeedSearch search_;
  std::vector<std::size_t> order_;
  std::vector<double> used_;
  std::size_t deciding_;
  const TrialAtSpeed& trial_;
};

FoundSpeed found(double speed, const Counts& there, FoundSpeed::Bound bound) {
  return {speed, bound, there.exceeded, there.untested};
}

FoundSpeed::Bound bound_of(const Counts& above, const SpeedSearch& search) {
  return above.exceeded > search.tolerated ? FoundSpeed::Bound::force : FoundSpeed::Bound::motion;
}

}  // namespace

FoundSpeed find_speed(const SpeedSearch& search, const TrialAtSpeed& trial) {
  const Ladder ladder(search);
  Trials trials(search, trial);
  const Counts at_slowest = trials.all_at(ladder[0]);
  if (!trials.are_within(at_slowest))
    return {std::nullopt, bound_of(at_slowest, search), at_slowest.exceeded, at_slowest.untested};
  trials.sort_by_use();
  Counts above;  // at `high`
  for (int high = ladder.top() + 1;;) {
    int low = 0;
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      const Counts counts = trials.hardest_at(ladder[middle]);
      const bool is_within = trials.are_within(counts);
      (is_within ? low : high) = middle;
      if (!is_within) above = counts;
    }
    const FoundSpeed::Bound bound =
        high > ladder.top() ? FoundSpeed::Bound::fastest : bound_of(above, search);
    if (low == 0) return found(ladder[0], at_slowest, bound);
    const Counts counts = trials.all_at(ladder[low]);
    if (trials.are_within(counts)) return found(ladder[low], counts, bound);
    high = low;
    above = counts;
  }
}

}  // namespace flinch
