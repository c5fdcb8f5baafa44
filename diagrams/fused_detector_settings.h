#pragma once

#include <string>
#include <vector>

#include "systems/contact/whitened_detector.h"

namespace flinch {

/// By which residual the fused detector judges, and how.
struct FusedResidual {
  std::string estimator;  ///< one of `estimator_stages()`, or one that runs
  SurpriseThreshold level, change;
};

/// Found by `flinch calibrate thresholds`.
struct FusedDetectorSettings {
  std::vector<FusedResidual> residuals;  ///< none: the detector only tells the loads that calibration needs
  ResidualTracking tracking;
};

}  // namespace flinch
