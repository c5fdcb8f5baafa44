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
FaultReport checked(const FaultReport& report, const TorqueCommand& command) {
  if (!report.valid) return {.valid = true, .present = fault_bit(GateFault::station_silent)};
  FaultReport found = report;
  if (report.intolerable() == 0 && !usable(command)) found.present |= fault_bit(GateFault::command_invalid);
  return found;
}

GateStatus opened(Time now, GateFault last_fault) {
  return {.phase = GatePhase::open, .reaction = GateReaction::none, .fault = last_fault, .since = now};
}

GateStatus recovering(Time now, GateFault last_fault, FaultMask present) {
  return {.phase = GatePhase::recovering,
          .reaction = GateReaction::none,
          .fault = last_fault,
          .faults = present,
          .since = now};
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
  if (!(settings.recovery_torque > 0 && settings.recovery_torque <= 1))
    problems.emplace_back("torque gate: recovery_torque must be above 0 and at most 1");
  if (settings.recovered_after < Time::zero())
    problems.emplace_back("torque gate: recovered_after must not be negative");
  throw_if_any(std::move(problems));
}

void TorqueGate::decide(Time now, const Decision& last, const FaultReport& report, const TorqueCommand& asked,
                        const TorqueCommand& stopping, const ResetCommand& button, Decision& decision) const {
  const FaultReport found = checked(report, asked);
  decision.status = advance(now, last, found, usable(stopping), button.reset && found.at_rest);
  const bool recovers = decision.status.phase == GatePhase::recovering;
  const bool begins = recovers && last.status.phase != GatePhase::recovering;
  decision.faulty = begins || found.present != 0 ? now : last.faulty;
  const TorqueCommand& wanted = decision.status.passes() ? asked : stopping;
  if (decision.status.reaction == GateReaction::zero_torque_and_brake) {
    decision.torque = {.computed = now, .valid = false, .torque = JointVector::Zero(wanted.torque.size())};
  } else {
    const double share = recovers ? settings_.recovery_torque : 1.0;
    decision.torque = limited(now, last.torque, wanted, share * settings_.max_torque);
    decision.status.saturated = decision.torque.torque != wanted.torque;
  }
}

GateStatus TorqueGate::advance(Time now, const Decision& decided, const FaultReport& report,
                               bool stop_possible, bool pressed) const {
  const GateStatus& last = decided.status;
  const FaultMask found = report.present;
  GateStatus next = last;
  next.saturated = false;
  switch (last.phase) {
    case GatePhase::waiting:
      if (found == 0) return opened(now, last.fault);
      if (pressed && report.intolerable() == 0) return recovering(now, last.fault, found);
      next.faults = found;
      return next;
    case GatePhase::closed:
      if (pressed && found == 0) return opened(now, last.fault);
      if (pressed && report.intolerable() == 0) return recovering(now, last.fault, found);
      react(next, found, stop_possible);
      return next;
    case GatePhase::recovering:
      if (found == 0 && now - decided.faulty >= settings_.recovered_after) return opened(now, last.fault);
      next.faults = found;
      if (report.intolerable() == 0) return next;
      break;
    case GatePhase::open:
      if (found == 0) return next;
      break;
  }
  const GateFault first = first_fault(last.phase == GatePhase::recovering ? report.intolerable() : found);
  next = {.phase = GatePhase::closed, .reaction = GateReaction::none, .fault = first, .since = now};
  react(next, found, stop_possible);
  return next;
}

TorqueCommand TorqueGate::limited(Time now, const TorqueCommand& last, const TorqueCommand& wanted,
                                  double most) const {
  const Eigen::Index drives = wanted.torque.size();
  const double change = settings_.max_torque_rate * to_seconds(now - last.computed);
  const JointVector before =
      last.valid && last.torque.size() == drives ? last.torque : JointVector::Zero(drives).eval();
  const JointVector bounded = wanted.torque.cwiseMin(most).cwiseMax(-most);
  return {
      .computed = now,
      .valid = true,
      .torque =
          bounded.cwiseMin((before.array() + change).matrix()).cwiseMax((before.array() - change).matrix())};
}

}  // namespace flinch
