#pragma once

#include "systems/framework/system.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/reset_command.h"
#include "systems/signals/start_command.h"

namespace flinch {

/// Turns the operator's buttons into events, each true for the one tick at which its button goes down: a
/// button that stays down resets one reaction, not every one that follows. A button that is down when the run
/// starts does nothing until it has been up.
class OperatorButtons final : public System {
  State<OperatorCommand> before_ = state<OperatorCommand>("before", {.start = true, .reset = true});

 public:
  InputPort<OperatorCommand> buttons = input<OperatorCommand>("buttons");
  OutputPort<StartCommand> start = output<&OperatorButtons::start_pressed>("start", before_, buttons);
  OutputPort<ResetCommand> reset = output<&OperatorButtons::reset_pressed>("reset", before_, buttons);

 private:
  Update remember_ = keep(before_, buttons);

  StartCommand start_pressed(const OperatorCommand& before, const OperatorCommand& now) const;
  ResetCommand reset_pressed(const OperatorCommand& before, const OperatorCommand& now) const;
};

}  // namespace flinch
