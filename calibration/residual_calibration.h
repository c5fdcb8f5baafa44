#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibration/threshold_calibration.h"
#include "systems/contact/onset_ratio.h"
#include "systems/contact/residual_errors.h"

namespace flinch {

struct ContactControlSettings;
struct Recording;

/// Motion without contact in which a fused detector told the loads of the drives.
struct ResidualRecording {
  const Recording* recording;
  std::vector<bool> nominal;  ///< samples that count: nominal_samples() or moving_samples()
  /// Of the detector that shall judge, by estimator.
  std::map<std::string, ResidualTracking> tracking;

  /// For the fused detector of these settings.
  ResidualRecording(const Recording& of, std::vector<bool> samples, const ContactControlSettings& settings);
};

/// When the level of a residual, its change, or what is smoothed of it is a contact.
struct CalibratedDistance {
  ResidualErrors errors;
  double variation = 0.0;         ///< of the errors' variance beside what is expected, see `MahalanobisTail`
  double between_robots = 0.0;    ///< the part of it by which the recorded robots differ
  CalibratedThreshold threshold;  ///< of what is left once the errors have deviation 1
};

/// When the onsets that a residual's change tells of are a contact.
struct CalibratedOnset {
  AutoregressiveError course;  ///< of the change, divided by its deviation
  CalibratedThreshold threshold;
};

struct CalibratedResidual {
  std::string estimator;
  std::size_t stretches = 0;
  CalibratedDistance level, change, smoothed;
  /// None where no samples follow one another without a gap, as those of an IMU that is slow.
  std::optional<CalibratedOnset> onset;
};

/// Sizes of the errors, fitted to all recordings together, and thresholds, so that all residuals together
/// give the rate of false alarms that is asked: the level of each, its change or its onset, and what is
/// smoothed of it have an equal share. The residuals are those by which a fused detector judges, as far as
/// all recordings have the estimates; none where one has no loads. `progress` is told the share that is done.
/// Throws SetupError as `calibrate_thresholds`.
std::vector<CalibratedResidual> calibrate_residuals(const std::vector<ResidualRecording>& recordings,
                                                    const ThresholdGoal& goal,
                                                    const std::function<void(double)>& progress = {});

/// The same; where there can be none, why is added to `left_out`.
std::vector<CalibratedResidual> calibrate_residuals(const std::vector<ResidualRecording>& recordings,
                                                    const ThresholdGoal& goal,
                                                    std::vector<std::string>& left_out,
                                                    const std::function<void(double)>& progress = {});

}  // namespace flinch
