#include "experiments/bus/operator_command_queue.h"

#include <utility>

#include "diagrams/contact_control_settings.h"

namespace flinch {

const char* sentence(Refusal refusal) noexcept {
  switch (refusal) {
    case Refusal::moves:
      return "reset has no effect while the robot moves";
    case Refusal::not_nominal:
      return "start, go and step have no effect in this mode; reset first";
    case Refusal::before_arrival:
      return "start has no effect before the robot is at rest";
    case Refusal::too_fast:
      return "go and step have no effect while the robot moves so fast; stop it first";
    case Refusal::out_of_reach:
      return "step has no effect: it leads out of the reach of the legs";
    case Refusal::overtaken:
      return "what waited has no effect, since stop was ordered";
    case Refusal::none:
      break;
  }
  return "";
}

OperatorCommandQueue::OperatorCommandQueue(const LiveExperiment& experiment,
                                           const ContactControlSettings& control)
    : target_(experiment.diagram->slot(experiment.target)),
      joints_(experiment.diagram->slot(experiment.control.joint_motion)),
      reaction_(experiment.diagram->slot(experiment.control.reaction_state)),
      reference_(experiment.diagram->slot(experiment.control.reference)),
      rest_speed_(control.faults.rest_speed),
      approach_(control.trajectory.approach),
      recovery_(control.trajectory.recovery),
      translations_(experiment.translations) {}

bool OperatorCommandQueue::give(const OperatorOrder& order) noexcept {
  if (order.end) end_.store(true, std::memory_order_relaxed);
  if (order.buttons.stop) stop_.store(true, std::memory_order_relaxed);
  return order.end || order.buttons.stop || orders_.push(order);
}

Refusal OperatorCommandQueue::objection(const OperatorOrder& order) const {
  if (order.buttons.reset) return moves_ ? Refusal::moves : Refusal::none;
  const bool is_nominal = mode_ == ReactionMode::nominal, recovers = mode_ == ReactionMode::recover;
  if (order.buttons.start) {
    if (!is_nominal) return Refusal::not_nominal;
    return present_.valid && present_.finished ? Refusal::none : Refusal::before_arrival;
  }
  if ((!is_nominal && !recovers) || !present_.valid) return Refusal::not_nominal;
  const bool is_too_fast = is_faster(present_.velocity, translations_, recovers ? recovery_ : approach_);
  return is_too_fast ? Refusal::too_fast : Refusal::none;
}

void OperatorCommandQueue::stop() noexcept {
  is_stopped_ = true;
  reset_is_next_ = false;
  OperatorOrder waiting;
  while (orders_.pop(waiting)) refuse(Refusal::overtaken);
}

OperatorOrder OperatorCommandQueue::next() {
  OperatorOrder order;
  if (std::exchange(reset_is_next_, false)) {
    follows_ = true;
    order.buttons.reset = true;
    return order;
  }
  follows_ = !follows_ && orders_.pop(order);
  if (!follows_) return {};
  const Refusal why = objection(order);
  if (why != Refusal::none) {
    refuse(why);
    return {};
  }
  if (order.buttons.reset && is_stopped_) {
    is_stopped_ = false;
    reset_is_next_ = true;
    return {};
  }
  return order;
}

OperatorCommand OperatorCommandQueue::follow(Context& context) {
  if (stop_.exchange(false, std::memory_order_relaxed)) stop();
  OperatorOrder order = next();
  resets_ = order.buttons.reset;
  const TargetCommand::Kind kind = order.target.kind;
  steps_ = kind == TargetCommand::Kind::step && order.target.step.norm() > 0.0;
  if (kind != TargetCommand::Kind::none) {
    order.target.number = context[target_].number + 1;
    context[target_] = order.target;
  }
  return {.start = order.buttons.start, .reset = order.buttons.reset, .stop = is_stopped_};
}

void OperatorCommandQueue::see(const Context& context) {
  const JointMotion& joints = context[joints_];
  moves_ = joints.valid && !joints.rests(rest_speed_);
  mode_ = context[reaction_].mode;
  const bool rested = present_.valid && present_.finished;
  present_ = context[reference_];
  if (steps_ && rested && present_.valid && present_.finished) refuse(Refusal::out_of_reach);
}

}  // namespace flinch
