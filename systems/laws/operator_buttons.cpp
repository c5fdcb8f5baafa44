#include "systems/laws/operator_buttons.h"

namespace flinch {

StartCommand OperatorButtons::start_pressed(const OperatorCommand& before, const OperatorCommand& now) const {
  return {.start = now.start && !before.start};
}

ResetCommand OperatorButtons::reset_pressed(const OperatorCommand& before, const OperatorCommand& now) const {
  return {.reset = now.reset && !before.reset};
}

}  // namespace flinch
