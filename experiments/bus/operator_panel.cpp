#include "experiments/bus/operator_panel.h"

#include <utility>

namespace flinch {

OperatorPanel::OperatorPanel(const LiveExperiment& experiment, const DdsStation& station,
                             InterruptCount interrupts)
    : station_(station),
      interrupts_(std::move(interrupts)),
      buttons_(experiment.diagram->slot(experiment.operator_command)),
      reaction_(experiment.diagram->slot(experiment.control.reaction_state)),
      gate_(experiment.diagram->slot(experiment.control.gate)),
      wrench_(experiment.diagram->slot(experiment.control.wrench_estimate)),
      translations_(experiment.translations) {}

void OperatorPanel::set_inputs(Context& context) {
  context[buttons_] = {.start = false, .reset = false, .stop = stop_ || interrupts_() > 0};
}

void OperatorPanel::take_outputs(const Context& context) {
  const WrenchEstimate& wrench = context[wrench_];
  LiveState now;
  now.time = context.time();
  now.mode = context[reaction_].mode;
  now.gate = context[gate_];
  if (wrench.valid) now.force = wrench.wrench_in_base.head(translations_).norm();
  now.link = station_.link();
  states_.publish(now);
}

}  // namespace flinch
