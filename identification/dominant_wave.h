#pragma once

#include <vector>

namespace flinch {

/// What is left at a place, and by what a wave there is multiplied.
struct WaveSample {
  double position = 0.0;
  double factor = 1.0;
  double left = 0.0;
  double blur = 0.0;  ///< of a wave that goes on by 1 rad within it half is left
};

/// How fast a wave goes on along the way, how well that is known, and what share of the scatter it explains.
struct Wave {
  double rate = 0.0;
  double deviation = 0.0;
  double least = 0.0;  ///< rate: of so few waves over the way that nothing else is like them
  double explained = 0.0;
};

/// The wave that explains most of what is left, from `fewest` waves over the range of the positions up to
/// where neighbours alternate; none, of rate 0, where it explains less than the share `least`, or than noise
/// might. Samples follow one another in time.
Wave dominant_wave(const std::vector<WaveSample>& samples, double fewest, double least);

}  // namespace flinch
