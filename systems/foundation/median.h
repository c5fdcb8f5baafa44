#pragma once

#include <vector>

namespace flinch {

/// The middle of the values, or of the two in the middle; not a number where there are none.
double median(std::vector<double> values);

}  // namespace flinch
