#pragma once

#include <string>
#include <vector>

namespace flinch {

struct Scenario;

/// What is doubtful about the calibrations of a scenario once it has been read, one sentence each: of another
/// robot file; resting on torque constants that are no longer used; one replacing another; thresholds of the
/// scenario that do not count beside those of estimators.
std::vector<std::string> doubts_about_calibrations(const Scenario& scenario);

}  // namespace flinch
