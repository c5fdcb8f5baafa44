#include "apps/flinch/bus/operator_panel.h"

namespace flinch {

bool is_at_rest(const JointMotion& joints) {
  constexpr double resting_speed = 0.05;  // [rad/s]
  return joints.valid && joints.velocity.cwiseAbs().maxCoeff() < resting_speed;
}

OperatorPanel::OperatorPanel(const LiveExperiment& experiment, const DdsStation& station)
    : station_(station),
      buttons_(experiment.diagram->slot(experiment.operator_command)),
      reaction_(experiment.diagram->slot(experiment.control.reaction_state)),
      gate_(experiment.diagram->slot(experiment.control.gate)),
      wrench_(experiment.diagram->slot(experiment.control.wrench_estimate)),
      joints_(experiment.diagram->slot(experiment.control.joint_motion)) {}

void OperatorPanel::set_inputs(Context& context) {
  context[buttons_] = {.start = false, .reset = false, .stop = stop_pressed()};
}

void OperatorPanel::take_outputs(const Context& context) {
  const WrenchEstimate& wrench = context[wrench_];
  LiveState now;
  now.time = context.time();
  now.mode = context[reaction_].mode;
  now.gate = context[gate_];
  if (wrench.valid) now.force = wrench.wrench_in_base.head<2>().norm();
  now.at_rest = is_at_rest(context[joints_]);
  now.link = station_.link();
  states_.publish(now);
}

}  // namespace flinch
