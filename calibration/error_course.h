#pragma once

#include <span>
#include <vector>

#include "systems/contact/onset_ratio.h"

namespace flinch {

/// The course of errors by which each is best told from those before it, in the mean square. `rows`: each the
/// errors of one drive, divided by their deviations, one sample after the other without a gap. The
/// innovation is a thousandth of a deviation at least.
ErrorCourse fit_error_course(std::span<const std::vector<double>> rows);

}  // namespace flinch
