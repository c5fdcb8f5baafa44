#pragma once

#include <optional>

#include "diagrams/contact_control.h"
#include "diagrams/control_stages.h"
#include "systems/sensors/first_order_low_pass.h"

namespace flinch {

/// Adds what force sensors below the base joints tell of contacts, and shows it; returns where their readings
/// go. Nothing where the settings know of no such sensors. `aligned_with`: the low pass of the drive torques,
/// none: they have none. Throws SetupError for a robot that has no model of its base joints.
std::optional<InputPort<BaseForceReading>> add_base_forces(const StageSite& site, const ContactPorts& given,
                                                           const std::optional<LowPassSettings>& aligned_with,
                                                           OtherStages& shown);

}  // namespace flinch
