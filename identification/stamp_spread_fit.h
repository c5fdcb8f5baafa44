#pragma once

#include <optional>
#include <vector>

#include "identification/imu_pose_fit.h"
#include "identification/imu_samples.h"

namespace flinch {

/// By how much the stamps of an IMU err beyond what is the same for all of them.
struct StampSpread {
  double width = 0.0;      ///< Of the range in which they err, as likely anywhere in it; 0: none is seen [s].
  double deviation = 0.0;  ///< Standard deviation of the width; for 0 that which could hardly be seen [s].
};

/// A reading whose stamp errs by d differs by d times the slope of what it measures. So of the noise e of the
/// gyroscope, whatever it is, this is the part whose variance grows with the square of the slope w':
///   E b_k^2 = c_k ( s^2 + sigma^2 w'_k^2 ),   b_k = e_k - (h' e_{k-1} + h e_{k+1}) / (h + h'),
/// where b_k, the bend of e at sample k, is free of all that changes slowly, h and h' are the times from and
/// to the samples beside it, and c_k is 1 and the squares of their shares. Least squares of b^2 with the
/// weights of normal bends, over samples of which none is in two bends; none where the platform hardly turns.
/// The accelerometer does not count: the torques of the drives change at every tick, and so does what it
/// measures. (Derived.)
std::optional<StampSpread> fit_stamp_spread(const std::vector<ImuStretch>& stretches, const ImuPose& pose);

}  // namespace flinch
