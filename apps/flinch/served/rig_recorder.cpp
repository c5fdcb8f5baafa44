#include "apps/flinch/served/rig_recorder.h"

#include "apps/flinch/live/shown_run.h"
#include "experiments/live/spectator.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/report/report_samples.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/robot/quantity_units.h"

namespace flinch {

Recorder& rig_recorder(ShownRun& shown, const Diagram& rig, const SimulatedScenario& scenario) {
  return shown.spectator().begin(rig, quantity_units(*scenario.robot.robot),
                                 recorded_attributes(scenario, {{rig_alone, ""}}));
}

}  // namespace flinch
