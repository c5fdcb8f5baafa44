#pragma once

#include <string>

namespace flinch {

struct Recording;
struct Scenario;

/// How near the bodies of a simulated robot came to the obstacles of its scenario by moving towards them, in
/// one sentence that names the nearest pair, when, and by how much the obstacle would have to move. Of the
/// body that the scenario expects to be touched, or of all. "" where there is no obstacle, or the recording
/// does not tell.
std::string near_miss(const Scenario& scenario, const Recording& recording);

}  // namespace flinch
