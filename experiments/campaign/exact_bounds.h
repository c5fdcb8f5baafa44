#pragma once

#include <cstddef>
#include <optional>

namespace flinch {

/// Largest rate of a Poisson process that still shows at most `events` in `exposure` with a probability of
/// 1 - `confidence`: its one-sided upper bound, in events per unit of `exposure` (Garwood 1936). Infinite
/// without exposure.
double garwood_upper(std::size_t events, double exposure, double confidence = 0.95);

/// Its one-sided lower bound: the smallest rate that still shows at least `events` with that probability.
/// Zero without events.
double lower_rate(std::size_t events, double exposure, double confidence = 0.95);

/// Largest probability under which at most `events` of `trials` are seen with a probability of
/// 1 - `confidence`: the one-sided upper bound of Clopper and Pearson (1934). 1 without trials.
double clopper_pearson_upper(std::size_t events, std::size_t trials, double confidence = 0.95);

/// Confidence with which a probability is below `share` where `events` of `trials` were seen: one minus the
/// probability of at most so many events at that share. The inverse of clopper_pearson_upper(); 0 without
/// trials.
double confidence_below(std::size_t events, std::size_t trials, double share);

/// The most events of `trials` that still show, with `confidence`, a probability below `share`; none where
/// even no event does. [Wilks 1941]: so many of the worst of a sample lie beyond the tolerance limit.
std::optional<std::size_t> tolerated_events(std::size_t trials, double share, double confidence = 0.95);

/// The fewest trials that show so without an event. `share` and `confidence` between 0 and 1.
std::size_t trials_without_event(double share, double confidence = 0.95);

/// Ranks of a sorted sample, from 1 on, between which the quantile `share` of what it was drawn from lies
/// with `confidence`, as much beyond either end: none where the sample is too small to bound that side.
struct RankBounds {
  std::optional<std::size_t> lower, upper;
};
RankBounds ranks_around_quantile(std::size_t count, double share, double confidence = 0.95);

}  // namespace flinch
