#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// What dry friction may do to the drives beyond what the model says: bounds, one entry a drive [Nm or N].
struct FrictionInterval {
  JointVector low, high;

  /// What of `effort` lies outside of the bounds.
  JointVector outside(const JointVector& effort) const {
    return effort - effort.cwiseMax(low).cwiseMin(high);
  }
  JointVector width() const { return high - low; }
};

/// The interval at `share` of the way from one to another.
inline FrictionInterval interval_between(const FrictionInterval& from, const FrictionInterval& to,
                                         double share) {
  return {from.low + share * (to.low - from.low), from.high + share * (to.high - from.high)};
}

}  // namespace flinch
