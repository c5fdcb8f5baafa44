#pragma once

#include "experiments/report/report.h"

namespace flinch {

struct Recording;
struct Scenario;
struct Verdict;

/// What the report page shows of a run: its recording, judged.
Report experiment_report(const Scenario& scenario, const Recording& recording, const Verdict& verdict);

}  // namespace flinch
