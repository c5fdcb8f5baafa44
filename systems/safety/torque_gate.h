#pragma once

#include "systems/framework/system.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reset_command.h"
#include "systems/signals/torque_command.h"

namespace flinch {

struct TorqueGateSettings {
  double max_torque = 100.0;  ///< of every drive [Nm]
  /// Largest change of a drive's torque [Nm/s]. The default is what a blend over 10 ms from one end of the
  /// torque range to the other needs.
  double max_torque_rate = 20e3;
  double recovery_torque = 0.3;  ///< share of `max_torque` that is left while recovering
  Time recovered_after = 100ms;  ///< without a fault, a recovery has come to its end
};

/// The only block that writes torque towards a station.
///
/// It is closed, with no torque and the brakes on, until a tick without any fault. Then it lets the laws'
/// torques through. At a fault it closes in the same tick and stays closed: it does what the worst of all
/// faults since asks for, and opens again only when the operator resets at a tick without faults at which the
/// robot rests: a law that took over a robot in motion would have to stop it once more. Should the controlled
/// stop have no valid torques, it falls back to no torque and brakes, and stays there.
///
/// Where the robot stands beyond a limit no tick is without faults. There the operator's reset, also at the
/// start of a run, begins a recovery: the gate lets the laws' torques through, reduced, as long as no other
/// fault is present than those which the report calls tolerable. It is open once there is none.
///
/// Torques that reach the station are always finite, bounded, and bounded in rate.
class TorqueGate final : public System {
 public:
  /// All that the gate decides at a tick.
  struct Decision {
    GateStatus status;
    TorqueCommand torque;
    Time faulty{};  ///< last tick of a recovery with a fault
  };

 private:
  State<Decision> last_ = state<Decision>("last");

 public:
  /// Throws SetupError for limits that are not positive.
  explicit TorqueGate(const TorqueGateSettings& settings);

  InputPort<FaultReport> faults = input<FaultReport>("faults");
  InputPort<TorqueCommand> command = input<TorqueCommand>("command");  ///< what the laws ask for
  InputPort<TorqueCommand> stop = input<TorqueCommand>("stop");        ///< of the controlled stop
  InputPort<ResetCommand> reset = input<ResetCommand>("reset");

 private:
  Intermediate<Decision> decision_ =
      intermediate<&TorqueGate::decide>("decision", clock, last_, faults, command, stop, reset);

 public:
  OutputPort<TorqueCommand> torque_command = output<&TorqueGate::torque_of>("torque_command", decision_);
  OutputPort<BrakeCommand> brake = output<&TorqueGate::brake_of>("brake", decision_);
  OutputPort<GateStatus> status = output<&TorqueGate::status_of>("status", decision_);

 private:
  Update remember_ = keep(last_, decision_);

  void decide(Time now, const Decision& last, const FaultReport& report, const TorqueCommand& asked,
              const TorqueCommand& stopping, const ResetCommand& button, Decision& decision) const;
  GateStatus advance(Time now, const Decision& last, const FaultReport& found, bool stop_possible,
                     bool pressed) const;
  TorqueCommand limited(Time now, const TorqueCommand& last, const TorqueCommand& wanted, double most) const;

  TorqueCommand torque_of(const Decision& decision) const { return decision.torque; }
  BrakeCommand brake_of(const Decision& decision) const { return {.engage = !decision.torque.valid}; }
  GateStatus status_of(const Decision& decision) const { return decision.status; }

  TorqueGateSettings settings_;
};

}  // namespace flinch
