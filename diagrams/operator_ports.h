#pragma once

#include "systems/laws/scripted_operator.h"

namespace flinch {

class DiagramBuilder;
struct ContactControl;

/// Where somebody at a panel presses buttons and gives targets.
struct OperatorPorts {
  InputPort<OperatorCommand> buttons;
  InputPort<TargetCommand> target;
};

/// An operator who does what a script says, and what somebody does at a panel.
struct ScriptedPorts {
  OperatorPorts panel;  ///< inputs of the diagram, "panel" and "panel_target"
  OutputPort<OperatorCommand> buttons;
  OutputPort<TargetCommand> target;
};

/// Adds such an operator before the control path.
ScriptedPorts add_scripted_operator(DiagramBuilder& builder, const ContactControl& control,
                                    const OperatorScript& script);

/// Makes the operator's buttons and targets inputs of the diagram, "operator" and "target". Where a script
/// does something as well, these are the names of the outputs by which panel and script together reach the
/// control path, and the inputs are called "panel" and "panel_target".
OperatorPorts add_operator(DiagramBuilder& builder, const ContactControl& control,
                           const OperatorScript& script);

}  // namespace flinch
