#pragma once

#include <string>
#include <vector>

#include "identification/pull_windows.h"

namespace flinch {

/// Why pulls and currents cannot be what they are said to be, each with its likely cause: a current or the
/// instrument with the other sign, axes of the instrument that are swapped or mirrored, currents in another
/// unit. `believed`: torque constants [Nm/A or N/A].
std::vector<std::string> warnings_about_pulls(const std::vector<PullWindow>& windows,
                                              const JointVector& believed);

}  // namespace flinch
