#pragma once

#include <string>

namespace flinch {

struct LegsParameters;

/// The keys of kind `legs` that say what `robot` is, as YAML: read again they are the same to rounding. What
/// is at its default is left out.
std::string legs_text(const LegsParameters& robot);

/// A number as files have it: the shortest that reads the same; 0 where it is less than files can say.
std::string yaml_number(double value);

}  // namespace flinch
