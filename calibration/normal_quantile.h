#pragma once

namespace flinch {

/// What the standard normal distribution is below with this probability.
double normal_quantile(double probability);

}  // namespace flinch
