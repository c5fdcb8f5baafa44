#include "systems/safety/torque_gate.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/safety/fault_table.h"

namespace flinch {
namespace {

bool usable(const TorqueCommand& command) {
  return command.valid && command.torque.size() > 0 && command.torque.allFinite();
}

/// A report that was not made is as bad as a station that says nothing; a command is looked at once more.
FaultMask present(const FaultReport& report, const TorqueCommand& command) {
  if (!report.valid) return fault_bit(GateFault::station_silent);
  return report.present == 0 && !usable(command) ? fault_bit(GateFault::command_invalid) : report.present;
}

GateStatus opened(Time now, GateFault last_fault) {
  return {.phase = GatePhase::open, .reaction = GateReaction::none, .fault = last_fault, .since = now};
}

/// Adds `found` to what the closed gate reacts to.
void react(GateStatus& status, FaultMask found, bool stop_possible) {
  status.faults |= found;
  status.reaction = std::max(status.reaction, worst_reaction(found));
  if (!stop_possible) status.reaction = GateReaction::zero_torque_and_brake;
}

}  // namespace

TorqueGate::TorqueGate(const TorqueGateSettings& settings) : settings_(settings) {
  std::vector<std::string> problems;
  if (!(settings.max_torque > 0)) problems.emplace_back("torque gate: max_torque must be positive");
  if (!(settings.max_torque_rate > 0)) problems.emplace_back("torque gate: max_torque_rate must be positive");
  throw_if_any(std::move(problems));
}

void TorqueGate::decide(Time now, const Decision& last, const FaultReport& report, const TorqueCommand& asked,
                        const TorqueCommand& stopping, const ResetCommand& button, Decision& decision) const {
  decision.status = advance(now, last.status, present(report, asked), usable(stopping), button.reset);
  const TorqueCommand& wanted = decision.status.phase == GatePhase::open ? asked : stopping;
  if (decision.status.reaction == GateReaction::zero_torque_and_brake) {
    decision.torque = {.computed = now, .valid = false, .torque = JointVector::Zero(wanted.torque.size())};
  } else {
    decision.torque = limited(now, last.torque, wanted);
    decision.status.saturated = decision.torque.torque != wanted.torque;
  }
}

GateStatus TorqueGate::advance(Time now, const GateStatus& last, FaultMask found, bool stop_possible,
                               bool pressed) const {
  const bool may_open = last.phase == GatePhase::waiting || pressed;
  if (last.phase != GatePhase::open && found == 0 && may_open) return opened(now, last.fault);

  GateStatus next = last;
  next.saturated = false;
  if (last.phase == GatePhase::waiting) {
    next.faults = found;
  } else if (last.phase == GatePhase::closed) {
    react(next, found, stop_possible);
  } else if (found != 0) {
    next = {.phase = GatePhase::closed,
            .reaction = GateReaction::none,
            .fault = first_fault(found),
            .since = now};
    react(next, found, stop_possible);
  }
  return next;
}

TorqueCommand TorqueGate::limited(Time now, const TorqueCommand& last, const TorqueCommand& wanted) const {
  const Eigen::Index drives = wanted.torque.size();
  const double change = settings_.max_torque_rate * to_seconds(now - last.computed);
  const JointVector before =
      last.valid && last.torque.size() == drives ? last.torque : JointVector::Zero(drives).eval();
  const JointVector bounded = wanted.torque.cwiseMin(settings_.max_torque).cwiseMax(-settings_.max_torque);
  return {
      .computed = now,
      .valid = true,
      .torque =
          bounded.cwiseMin((before.array() + change).matrix()).cwiseMax((before.array() - change).matrix())};
}

}  // namespace flinch
