#pragma once

#include <vector>

#include "calibration/residual_calibration.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// Of the estimate that classifiers and locators read.
inline constexpr const char* isolation_signal = "isolation_wrench";

/// What the observer of the isolation takes for torques of a contact at each drive where nothing touches the
/// robot: root mean square over all samples that count, one entry a drive [Nm or N]. An estimate has as many
/// coordinates as the platform: of more drives it tells that share of their errors. None is less than what
/// `least`, which is right for contacts with a robot that hardly errs, means at the drives at home. Empty
/// where none is more, where a recording has no such estimate, or where no sample of it counts.
JointVector drive_deviations(const std::vector<ResidualRecording>& recordings, const ParallelRobot& robot,
                             const WrenchUncertainty& least);

}  // namespace flinch
