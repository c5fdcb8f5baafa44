#pragma once

#include "experiments/verdict/verdict.h"

namespace flinch {

struct Recording;
struct Scenario;

/// What the recording shows, judged as its scenario asks, with what is doubtful about its calibrations among
/// the remarks. Throws SetupError when signals are missing.
Verdict verdict_of(const Scenario& scenario, const Recording& recording,
                   const std::function<void(double share)>& progress = {});

}  // namespace flinch
