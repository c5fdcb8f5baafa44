#pragma once

#include <span>

#include "systems/contact/residual_errors.h"

namespace flinch {

/// The error of one drive's residual at one instant, squared, and what it may have grown with.
struct ErrorSample {
  double squared = 0.0;  ///< [Nm^2 or N^2]
  ErrorFeatures features{};
  double known = 0.0;  ///< part of its variance that need not be found [Nm^2 or N^2]
};

/// The sizes of errors under which these samples, taken as normal and independent, are most likely. What does
/// not explain any of them is zero; the noise is not. Needs one sample or more that is not zero.
ResidualErrors fit_error_sizes(std::span<const ErrorSample> samples);

}  // namespace flinch
