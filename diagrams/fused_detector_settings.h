#pragma once

#include <optional>
#include <string>
#include <vector>

#include "systems/contact/whitened_detector.h"

namespace flinch {

/// By which residual the fused detector judges, and how.
struct FusedResidual {
  std::string estimator;  ///< one of `estimator_stages()`, or one that runs
  MahalanobisThreshold level, change;
  std::optional<MahalanobisThreshold> smoothed{};
  std::optional<OnsetThreshold> onset{};  ///< needed where likelihood ratios are the rule
};

/// By what a residual's change is judged.
enum class ChangeRule {
  chi_square,        ///< as it is
  likelihood_ratio,  ///< with how it has come about
};

/// Found by `flinch calibrate thresholds`.
struct FusedDetectorSettings {
  std::vector<FusedResidual> residuals;  ///< none: the detector only tells the loads that calibration needs
  ChangeRule rule = ChangeRule::chi_square;
  ResidualTracking tracking;
};

}  // namespace flinch
