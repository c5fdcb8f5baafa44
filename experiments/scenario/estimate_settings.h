#pragma once

#include <vector>

#include "systems/config/read_value.h"

namespace flinch {

struct Scenario;

/// The settings of a scenario's control path on which the errors of its estimates rest, as they took effect:
/// of the velocity and acceleration stages and the estimators that run, with those on which these rest, which
/// velocity and acceleration are followed, where the IMU is believed to sit, whether the torque is aligned
/// with the velocity, and a control period that is not the usual one. Not among them are the torque
/// constants, of which a calibration says itself on which it rests.
std::vector<ReadValue> estimate_settings(const Scenario& scenario);

}  // namespace flinch
