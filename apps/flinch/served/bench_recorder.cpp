#include "apps/flinch/served/bench_recorder.h"

#include "apps/flinch/live/shown_run.h"
#include "experiments/live/spectator.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/report/report_samples.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/robot/quantity_units.h"

namespace flinch {

Recorder& bench_recorder(ShownRun& shown, const Diagram& bench, const SimulatedScenario& scenario) {
  return shown.spectator().begin(bench, quantity_units(*scenario.robot.robot),
                                 recorded_attributes(scenario, {{bench_alone, ""}}));
}

}  // namespace flinch
