#pragma once

namespace flinch {

/// What chi-square of so many degrees, one or more, is below with this probability, above 0 and below 1.
double chi_square_quantile(int degrees, double probability);

}  // namespace flinch
