#pragma once

namespace flinch {

/// Standard deviation of the momentum that is measured, each sample by itself: by it an observer knows how
/// uncertain its estimate is.
struct MomentumDeviation {
  double translation = 0.01;  ///< [Ns]
  double rotation = 0.001;    ///< [Nms]
};

}  // namespace flinch
