#pragma once

#include "experiments/report/report.h"

namespace flinch {

struct Recording;
struct Scenario;
struct Verdict;

/// What the recording shows, judged as its scenario asks, with what is doubtful about its calibrations among
/// the remarks. Throws SetupError when signals are missing.
Verdict verdict_of(const Scenario& scenario, const Recording& recording);

/// What the report page shows of a run: its recording, judged.
Report experiment_report(const Scenario& scenario, const Recording& recording, const Verdict& verdict);

}  // namespace flinch
