#pragma once

#include <string>
#include <vector>

#include "identification/imu_pose_fit.h"

namespace flinch {

/// Why the readings of an IMU cannot be what they are said to be, each with its likely cause: units, signs,
/// gravity that was removed, axes that are no right-handed system, biases and a delay beyond what is believed
/// of any such sensor. Beside the encoders; a rotation about the vertical is no doubt, for the fit finds it.
std::vector<std::string> warnings_about_imu(const std::vector<ImuStretch>& stretches, const ImuBelief& belief,
                                            const ImuPoseFit& fit);

}  // namespace flinch
