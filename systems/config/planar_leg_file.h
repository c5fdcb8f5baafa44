#pragma once

#include <string>
#include <vector>

#include "systems/config/config_reader.h"
#include "systems/robot/planar_leg_parameters.h"

namespace flinch {

/// The keys that every planar leg of two links has.
void read_planar_leg(ConfigReader& file, PlanarLegParameters& leg);

/// Name in the file of a field of a planar robot: of inertia, as each of `legs` gives it, of the platform and
/// of all that is called the same.
std::string planar_name_in_file(std::string field, const std::vector<ConfigReader>& legs);

}  // namespace flinch
