#pragma once

#include <vector>

#include "systems/config/read_value.h"

namespace flinch {

struct Scenario;

/// The settings of a scenario's control path on which the errors of its estimates rest, as they took effect:
/// of the velocity and acceleration stages and the estimators that run, with those on which these rest, which
/// velocity and acceleration are followed, and whether the torque is aligned with the velocity. Not among
/// them is what is calibrated for each robot: torque constants, and where the IMU sits.
std::vector<ReadValue> estimate_settings(const Scenario& scenario);

}  // namespace flinch
