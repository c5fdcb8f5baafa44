#include "import/log_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "import/clock_rows.h"
#include "systems/foundation/median.h"

namespace flinch {
namespace {

constexpr std::int64_t bridged_periods = 3;

/// Rows that have a number, from one to the next of them, in the middle of all.
std::size_t usual_spacing(const std::vector<double>& values) {
  std::vector<double> spacings;
  spacings.reserve(values.size());
  std::size_t last = 0;
  bool any = false;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    if (any) spacings.push_back(static_cast<double>(k - last));
    any = true;
    last = k;
  }
  if (spacings.empty()) return 1;
  return static_cast<std::size_t>(std::lround(median(std::move(spacings))));
}

}  // namespace

std::size_t LogTrack::row_before(std::int64_t instant, std::size_t hint) const {
  const std::vector<std::int64_t>& all = *instants;
  if (hint < all.size() && all[hint] <= instant) {
    const std::size_t near = std::min(hint + 8, all.size());
    for (std::size_t k = hint + 1; k < near; ++k) {
      if (all[k] > instant) return k - 1;
    }
  }
  const auto later = std::upper_bound(all.begin(), all.end(), instant);
  return later == all.begin() ? 0 : static_cast<std::size_t>(later - all.begin()) - 1;
}

double LogTrack::at(std::int64_t instant, std::size_t row) const {
  const std::vector<std::int64_t>& all = *instants;
  if (row >= all.size() || instant < all[row]) return std::nan("");
  if (instant == all[row]) return values[row];
  if (row + 1 >= all.size() || all[row + 1] - all[row] > longest_bridge) return std::nan("");
  const double share = static_cast<double>(instant - all[row]) / static_cast<double>(all[row + 1] - all[row]);
  return (1.0 - share) * values[row] + share * values[row + 1];
}

LogTrack log_track(std::shared_ptr<const std::vector<std::int64_t>> instants, std::vector<double> values) {
  if (usual_spacing(values) > 1) {
    auto own = std::make_shared<std::vector<std::int64_t>>();
    std::size_t kept = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!std::isfinite(values[k])) continue;
      own->push_back((*instants)[k]);
      values[kept++] = values[k];
    }
    values.resize(kept);
    instants = own;
  }
  const std::int64_t bridge = bridged_periods * clock_rate(*instants).period;
  // A thousandth more, so that stamps which are rounded do not fall short of it.
  return {std::move(instants), std::move(values), bridge + bridge / 1000};
}

Unwrapped unwrap(std::vector<double>& values, double turn) {
  Unwrapped done;
  double added = 0.0, last = std::nan("");
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    const double step = values[k] - last;
    // Nothing turns three quarters of a turn from one row to the next.
    if (std::abs(step) > 0.75 * turn) {
      added -= turn * std::round(step / turn);
      if (done.steps++ == 0) done.first_row = k;
    }
    last = values[k];
    values[k] += added;
  }
  return done;
}

}  // namespace flinch
