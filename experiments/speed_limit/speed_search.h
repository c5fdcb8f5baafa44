#pragma once

#include <cstddef>
#include <functional>
#include <optional>

namespace flinch {

/// How a trial at a speed ended.
enum class SpeedTrial {
  within,    ///< The force stayed within its limits.
  exceeded,  ///< It did not.
  untested,  ///< The contact that was meant did not happen at that speed.
};

/// A trial, and how near it came.
struct TrialResult {
  SpeedTrial ended = SpeedTrial::untested;
  double used = 0.0;  ///< Largest force over its limit.
};

/// A search for the highest speed at which most trials are within the limits.
struct SpeedSearch {
  double slowest = 0.1;       ///< Lowest speed that is tried [m/s].
  double fastest = 2.0;       ///< Highest speed that is tried [m/s].
  double step = 0.03;         ///< Largest relative distance between neighbouring speeds.
  std::size_t trials = 29;    ///< Number of trials at each speed, the same at all.
  std::size_t tolerated = 0;  ///< Most trials of these that may exceed.
  std::size_t spares = 0;     ///< Most trials of these that may be untested.
};

/// What a search has found.
struct FoundSpeed {
  /// What stands against a higher speed.
  enum class Bound {
    force,    ///< A force exceeds its limits.
    motion,   ///< Too few of its contacts come about so fast.
    fastest,  ///< Nothing: it is the highest that was tried.
  };
  std::optional<double> speed;  ///< [m/s]; none: not even the slowest.
  Bound bound = Bound::force;
  std::size_t exceeded = 0;  ///< Trials at that speed, or at the slowest, that exceeded a limit.
  std::size_t untested = 0;  ///< Trials there without the contact.

  friend bool operator==(const FoundSpeed&, const FoundSpeed&) = default;
};

/// Trial number `trial` at `speed` [m/s].
using TrialAtSpeed = std::function<TrialResult(std::size_t trial, double speed)>;

/// Searches by bisection over speeds that grow by equal ratios: first how fast the trials may be that came
/// nearest to a limit, then whether all others may be so fast as well; those that may not are the nearest of
/// the next round. All trials are made at the speed that is found; at the next more than are tolerated
/// exceed, or more than the spares are untested.
FoundSpeed find_speed(const SpeedSearch& search, const TrialAtSpeed& trial);

}  // namespace flinch
