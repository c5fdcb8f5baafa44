#include "systems/contact/residual_errors.h"

#include <cmath>
#include <limits>

namespace flinch {
namespace {

constexpr double square(double value) { return value * value; }

}  // namespace

double ResidualErrors::variance(const ErrorFeatures& features) const {
  return square(noise) * features[0] + square(speed) * features[1] + square(load) * features[2] +
         square(torque) * features[3] + square(friction) * features[4] + square(lag) * features[5] +
         square(rest) * features[6] + square(acceleration) * features[7] + square(turning) * features[8];
}

ErrorFeatures error_features(const DriveLoad& load, const DriveResidual& seen, int drive) {
  return {1.0,
          square(load.rate[drive]),
          square(load.torque[drive]),
          square(seen.torque[drive]),
          square(seen.friction[drive]),
          square(seen.slope[drive]),
          square(seen.rest[drive]),
          square(load.inertia[drive]),
          square(load.turning[drive])};
}

double rising_variance(const DriveResidual& seen) {
  return seen.rising.squaredNorm() / static_cast<double>(seen.rising.size());
}

JointVector whitened(const DriveLoad& load, const DriveResidual& seen, const ResidualErrors& errors) {
  const double rising = rising_variance(seen);
  JointVector z = seen.effort;
  for (int i = 0; i < z.size(); ++i)
    z[i] /= std::sqrt(errors.variance(error_features(load, seen, i)) + rising);
  return z;
}

double mahalanobis_distance(const DriveLoad& load, const DriveResidual& seen, const ResidualErrors& errors) {
  const double rising = rising_variance(seen);
  double sum = 0.0;
  for (int i = 0; i < seen.effort.size(); ++i)
    sum += square(seen.effort[i]) / (errors.variance(error_features(load, seen, i)) + rising);
  return std::isfinite(sum) ? std::sqrt(sum) : std::numeric_limits<double>::infinity();
}

}  // namespace flinch
