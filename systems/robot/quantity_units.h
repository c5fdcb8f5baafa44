#pragma once

#include <map>
#include <string>

namespace flinch {

class ParallelRobot;

/// The units of the quantities that differ from mechanism to mechanism, by the names that values give for
/// their units:
///
///   <pose>, <velocity>, <acceleration>   of the platform, one unit for each number
///   <displacement>                       difference of two poses, one unit for each velocity
///   <wrench>                             on the platform, likewise
///   <drive position>, <drive velocity>, <drive force>, <drive inertia>   of every drive
///   <passive position>                   of every joint without a drive
std::map<std::string, std::string> quantity_units(const ParallelRobot& robot);

}  // namespace flinch
