#include "diagrams/operator_ports.h"

#include "diagrams/contact_control.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

ScriptedPorts add_scripted_operator(DiagramBuilder& builder, const ContactControl& control,
                                    const OperatorScript& script) {
  auto& scripted = builder.add<ScriptedOperator>("scripted_operator", script);
  builder.connect(control.joint_motion, scripted.joints);
  builder.connect(control.reaction_state, scripted.reaction);
  builder.connect(control.gate, scripted.gate);
  builder.connect(control.reference, scripted.reference);
  builder.connect(scripted.buttons, control.operator_command);
  builder.connect(scripted.target, control.target);
  return {{builder.export_input("panel", scripted.panel),
           builder.export_input("panel_target", scripted.panel_target)},
          scripted.buttons,
          scripted.target};
}

OperatorPorts add_operator(DiagramBuilder& builder, const ContactControl& control,
                           const OperatorScript& script) {
  if (script.events.empty()) {
    return {builder.export_input("operator", control.operator_command),
            builder.export_input("target", control.target)};
  }
  const ScriptedPorts scripted = add_scripted_operator(builder, control, script);
  builder.export_output("operator", scripted.buttons);
  builder.export_output("target", scripted.target);
  return scripted.panel;
}

}  // namespace flinch
