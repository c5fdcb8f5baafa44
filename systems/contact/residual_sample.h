#pragma once

#include <array>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"
#include "systems/signals/drive_load.h"
#include "systems/signals/history.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// What an estimator holds for the effort of the surroundings at the drives, beside what its errors grow
/// with, as late as it shows them; one entry a drive [Nm or N].
struct DriveResidual {
  JointVector effort;    ///< tau_a,ext as estimated, less what dry friction near rest can make of it
  JointVector torque;    ///< of the drives
  JointVector friction;  ///< that the model expects
  JointVector slope;     ///< of the torque [Nm/s or N/s]
  JointVector rising;  ///< of the torque, by which the drives may have gone further, see `driven_uncertainty`
  JointVector rest;    ///< how far the drive stands still, 0 to 1: what it then holds by friction is unknown
};

/// A residual as it is, what of it is new, and what lasts. All of it was acquired at one time.
struct ResidualSample {
  bool is_new = false;   ///< nothing was acquired since the last one: there is nothing to judge
  bool settled = false;  ///< the change means something
  bool smooth = false;   ///< and what is smoothed
  DriveLoad load;
  JointVector hidden;  ///< Width of the range in which dry friction near rest hides an effort [Nm or N].
  DriveResidual level;
  DriveResidual change;    ///< beside its mean of late, every part of it by the same filter
  DriveResidual smoothed;  ///< behind a low pass, likewise: its noise is gone
};

using LoadHistory = History<DriveLoad, late_samples>;

/// How an estimator answers an effort: through first-order filters in a row. What is wrong with the torque of
/// the drives shows in its residual through the same filters.
struct FilterResponse {
  static constexpr int most = 3;
  int filters = 0;
  double rate = 0.0;  ///< of each filter [1/s]
};

/// How a residual is followed.
struct ResidualTracking {
  FilterResponse answer;
  double rate = 50.0;          ///< of the first-order filter whose output is the mean of late [1/s]
  double smoothing = 400.0;    ///< of that whose output is the smoothed residual [1/s]
  double resting_rate = 0.05;  ///< below which a drive stands still [rad/s or m/s]
  Sampling sampling;

  Time settling_time() const { return from_seconds(3.0 / rate); }
  Time smoothing_time() const { return from_seconds(3.0 / smoothing); }
};

/// Torque and friction of the drives behind a filter [Nm or N], the bounds of dry friction near rest, and how
/// far they stand still; one entry a drive.
struct FilteredLoad {
  JointVector torque;
  JointVector friction;
  FrictionInterval friction_bounds;
  JointVector rest;
};

/// What is remembered of a residual.
struct ResidualMemory {
  bool started = false;
  Time acquired{};  ///< of the last estimate
  Time arrived{};   ///< tick at which it came
  Time since{};     ///< tick of the first one
  /// Behind each filter of the answer.
  std::array<FilteredLoad, FilterResponse::most> answered;
  DriveResidual mean;
  ResidualSample seen;
};

/// The estimate of a tick, whose residual is set beside the load of the time that it tells of, a fresh load
/// or one of `past`, as the estimator answers it. An estimate that is not valid, not finite, or has fallen
/// back to another estimator is none; after the longest hold without one, and after a gap, everything begins
/// anew. Of the effort counts what lies outside of the bounds of dry friction near rest, which pass the
/// filters of the answer too: these never give a negative answer, so that bounds stay bounds. `next`:
/// another object than `memory`, whatever it holds.
void track_residual(const WrenchEstimate& estimate, const DriveLoad& fresh, const LoadHistory& past, Time now,
                    const ResidualTracking& tracking, const ResidualMemory& memory, ResidualMemory& next);

}  // namespace flinch
