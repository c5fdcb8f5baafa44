#include "experiments/bus/operator_panel.h"

#include <utility>

namespace flinch {

OperatorPanel::OperatorPanel(const LiveExperiment& experiment, const ContactControlSettings& control,
                             const DdsStation& station, InterruptCount interrupts)
    : station_(station),
      interrupts_(std::move(interrupts)),
      buttons_(experiment.diagram->slot(experiment.operator_command)),
      reaction_(experiment.diagram->slot(experiment.control.reaction_state)),
      gate_(experiment.diagram->slot(experiment.control.gate)),
      wrench_(experiment.diagram->slot(experiment.control.wrench_estimate)),
      plausibility_(experiment.diagram->slot(experiment.control.plausibility)),
      translations_(experiment.translations),
      checks_drives_(!experiment.control.others.drive_checks.empty()),
      orders_(experiment, control) {}

void OperatorPanel::set_inputs(Context& context) {
  OperatorCommand buttons = orders_.follow(context);
  buttons.stop = buttons.stop || stop_ || interrupts_() > 0;
  context[buttons_] = buttons;
}

void OperatorPanel::take_outputs(const Context& context) {
  orders_.see(context);
  const WrenchEstimate& wrench = context[wrench_];
  askable_ |= context[plausibility_].askable;
  LiveState now;
  now.time = context.time();
  now.mode = context[reaction_].mode;
  now.gate = context[gate_];
  if (wrench.valid) now.force = wrench.wrench_in_base.head(translations_).norm();
  now.askable = askable_;
  now.checks_drives = checks_drives_;
  now.link = station_.link();
  now.refusals = orders_.refusals();
  states_.publish(now);
}

}  // namespace flinch
