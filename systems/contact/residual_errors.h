#pragma once

#include <array>

#include "systems/contact/residual_sample.h"

namespace flinch {

/// What the squared error of a drive's residual grows with: 1, and the squares of what `ResidualErrors` has.
using ErrorFeatures = std::array<double, 9>;

/// How large the errors of a residual are: deviations of independent parts, each in proportion to something.
struct ResidualErrors {
  double noise = 0.0;         ///< whatever the drive does [Nm or N]
  double speed = 0.0;         ///< with its rate [Nm s/rad or N s/m]
  double load = 0.0;          ///< with its torque
  double torque = 0.0;        ///< with the torque as the residual is seen, itself or its change
  double friction = 0.0;      ///< with the friction that the model expects, likewise
  double lag = 0.0;           ///< with the slope of the torque, likewise: how late currents are [s]
  double rest = 0.0;          ///< with how far the drive stands still, likewise [Nm or N]
  double acceleration = 0.0;  ///< with the inertia at the drive: how encoders err [rad/s^2 or m/s^2]
  double turning = 0.0;       ///< with what turns the platform: how stamps of a gyroscope err

  double variance(const ErrorFeatures& features) const;
};

/// Of a drive under `load`, whose residual is seen as `seen`: its level, or its change.
ErrorFeatures error_features(const DriveLoad& load, const DriveResidual& seen, int drive);

/// The variance that each drive's error has besides, by how far the drives may have gone: the mean of the
/// squares of `rising`, for what one drive makes of a force shows at all of them [Nm^2 or N^2].
double rising_variance(const DriveResidual& seen);

/// The residual, each drive's divided by its deviation: normal, of variance 1, where the errors are as
/// assumed.
JointVector whitened(const DriveLoad& load, const DriveResidual& seen, const ResidualErrors& errors);

/// The length of the residual once each drive's is divided by its deviation, sqrt(sum of r_i^2 / v_i): its
/// square is distributed as chi-square where the errors are as assumed. Infinite where it is not finite.
double mahalanobis_distance(const DriveLoad& load, const DriveResidual& seen, const ResidualErrors& errors);

}  // namespace flinch
