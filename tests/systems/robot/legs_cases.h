#pragma once

#include <filesystem>
#include <string>

#include "systems/robot/legs/legs_parameters.h"
#include "tests/systems/robot/mechanism_cases.h"

namespace flinch::test {

/// What the robot file of kind `legs` says.
LegsParameters legs_parameters_of(const std::filesystem::path& file);

/// A robot of legs as bodies that constraints hold together at each of its joints and closures. Its legs have
/// two links with mass each; a joint that follows another has none.
MechanismCase legs_case(const std::string& name, const LegsParameters& parameters,
                        const PlatformVector& region, const PlatformVector& velocity,
                        const Tolerances& tolerances = {});

/// Robots of the shipped files of this kind.
std::vector<MechanismCase> legs_cases();

}  // namespace flinch::test
