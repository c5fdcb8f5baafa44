#pragma once

#include <functional>
#include <utility>

#include "experiments/report/report.h"
#include "experiments/verdict/verdict.h"

namespace flinch {

struct Recording;
struct Scenario;

/// What of that is known before the run: title, robot, obstacles, thresholds.
Report planned_report(const Scenario& scenario);

/// What the report page shows of a run: its recording, judged.
Report experiment_report(const Scenario& scenario, const Recording& recording, const Verdict& verdict,
                         const std::function<void(double share)>& progress = {});

/// The verdict of a run and what its page shows. Throws SetupError when signals are missing.
std::pair<Verdict, Report> judged_report(const Scenario& scenario, const Recording& recording,
                                         const std::function<void(double share)>& progress = {});

}  // namespace flinch
