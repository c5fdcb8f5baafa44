#pragma once

#include <cstddef>

namespace flinch {

/// Largest rate of a Poisson process that still shows at most `events` in `exposure` with a probability of
/// 1 - `confidence`: its one-sided upper bound, in events per unit of `exposure` (Garwood 1936). Infinite
/// without exposure.
double upper_rate(std::size_t events, double exposure, double confidence = 0.95);

/// Its one-sided lower bound: the smallest rate that still shows at least `events` with that probability.
/// Zero without events.
double lower_rate(std::size_t events, double exposure, double confidence = 0.95);

/// Largest probability under which at most `events` of `trials` are seen with a probability of
/// 1 - `confidence`: the one-sided upper bound of Clopper and Pearson (1934). 1 without trials.
double upper_share(std::size_t events, std::size_t trials, double confidence = 0.95);

}  // namespace flinch
