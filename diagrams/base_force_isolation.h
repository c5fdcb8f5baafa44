#pragma once

#include <optional>

#include "diagrams/contact_control.h"
#include "diagrams/control_stages.h"

namespace flinch {

/// Adds what force sensors below the base joints tell of contacts, and shows it; returns where their readings
/// go. Nothing where the settings know of no such sensors. Throws SetupError for a robot that has no model of
/// its base joints.
std::optional<InputPort<BaseForceReading>> add_base_forces(const StageContext& site,
                                                           const ContactPorts& given, OtherStages& shown);

}  // namespace flinch
