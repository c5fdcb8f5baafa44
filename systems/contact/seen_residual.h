#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"
#include "systems/signals/drive_load.h"
#include "systems/signals/history.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// What an estimator holds for the effort of the surroundings at the drives, beside what its errors grow
/// with; one entry a drive [Nm or N].
struct DriveResidual {
  JointVector effort;    ///< tau_a,ext as estimated
  JointVector torque;    ///< of the drives at that time
  JointVector friction;  ///< that the model expects there
};

/// A residual as it is, and what of it is new. All of it was acquired at one time.
struct SeenResidual {
  bool is_new = false;   ///< nothing was acquired since the last one: there is nothing to judge
  bool settled = false;  ///< the change means something
  DriveLoad load;
  DriveResidual level;
  DriveResidual change;  ///< beside its mean of late, every part of it by the same filter
};

using LoadHistory = History<DriveLoad, 32>;

/// How a residual is followed.
struct ResidualTracking {
  double rate = 50.0;  ///< of the first-order filter whose output is the mean of late [1/s]
  Sampling sampling;

  Time settling_time() const { return from_seconds(3.0 / rate); }
};

/// What is remembered of a residual.
struct ResidualMemory {
  bool started = false;
  Time acquired{};  ///< of the last estimate
  Time arrived{};   ///< tick at which it came
  Time since{};     ///< tick of the first one
  DriveResidual mean;
  SeenResidual seen;
};

/// The estimate of a tick, whose residual is set beside the load of the time that it tells of: a fresh load,
/// or one of `past`. An estimate that is not valid, not finite, or has fallen back to another estimator is
/// none; after the longest hold without one, and after a gap, everything begins anew.
void follow_residual(const WrenchEstimate& estimate, const DriveLoad& fresh, const LoadHistory& past,
                     Time now, const ResidualTracking& tracking, const ResidualMemory& memory,
                     ResidualMemory& next);

}  // namespace flinch
