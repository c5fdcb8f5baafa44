#include "experiments/bus/operator_panel.h"

#include <utility>

namespace flinch {

OperatorPanel::OperatorPanel(const LiveExperiment& experiment, const DdsStation& station,
                             InterruptCount interrupts)
    : station_(station),
      interrupts_(std::move(interrupts)),
      buttons_(experiment.diagram->slot(experiment.operator_command)),
      target_(experiment.diagram->slot(experiment.target)),
      reaction_(experiment.diagram->slot(experiment.control.reaction_state)),
      gate_(experiment.diagram->slot(experiment.control.gate)),
      wrench_(experiment.diagram->slot(experiment.control.wrench_estimate)),
      translations_(experiment.translations) {}

void OperatorPanel::set_inputs(Context& context) {
  OperatorOrder order;
  follows_ = !follows_ && orders_.pop(order);
  resets_ = order.buttons.reset;
  end_is_ordered_ = end_is_ordered_ || order.end;
  order.buttons.stop = order.buttons.stop || stop_ || interrupts_() > 0;
  context[buttons_] = order.buttons;
  if (order.target.kind == TargetCommand::Kind::none) return;
  order.target.number = context[target_].number + 1;
  context[target_] = order.target;
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
