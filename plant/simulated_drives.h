#pragma once

#include <string>
#include <vector>

#include "diagrams/requested_fault.h"
#include "plant/drive_action.h"
#include "plant/plant_truth.h"
#include "systems/framework/system.h"
#include "systems/robot/mechanism.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// Drives with current control.
struct SimulatedDrivesSettings {
  /// What a motor makes of its current [Nm/A or N/A]; empty: as default_drives() says.
  JointVector torque_constant{};
  /// What the driver believes when it turns a torque command into a current; empty: the truth.
  JointVector driver_torque_constant{};
  /// Time constant with which each current follows its command [s]; empty: at once.
  JointVector current_lag{};
  JointVector torque_delay{};  ///< By which each torque is behind its current besides [s]; empty: none.
  /// Commands are cut to this [Nm or N]; empty: as default_drives() says.
  JointVector max_torque{};
  Time longest_silence = 3ms;  ///< Age of a command from which on it is not obeyed.
  /// Those of brakes, and of drives that make another torque of their current, act here; others are left to
  /// whatever stands before the drives.
  std::vector<RequestedFault> faults{};
};

/// All that is wrong with `settings` for the drives of `robot`.
std::vector<std::string> problems(const SimulatedDrivesSettings& settings, const Mechanism& robot);

/// The same with the constants and limits of all drives of `robot` written out. Throws SetupError.
SimulatedDrivesSettings complete(SimulatedDrivesSettings settings, const Mechanism& robot);

/// Turns commands into torque, held from tick to tick. Where the current lags the torque is its mean over the
/// tick, so that the robot's momentum at the ticks is exact, and the current that of the tick's end. A
/// command that is not valid or not finite, older than the longest silence or from the future, or that comes
/// with the brakes engaged, gives no torque and closes the brakes. The drives obey again at the first command
/// without these faults.
class SimulatedDrives final : public System {
  SimulatedDrivesSettings settings_;
  Time tick_;
  State<DriveAction> acting_ = state<DriveAction>("acting", at_rest());  // from this tick on

 public:
  /// `tick` is the time between ticks of the diagram, or a multiple of it. Throws SetupError.
  SimulatedDrives(const SimulatedDrivesSettings& settings, const Mechanism& robot, Time tick = 1ms);

  InputPort<TorqueCommand> torque_command = input<TorqueCommand>("torque_command");
  InputPort<BrakeCommand> brake = input<BrakeCommand>("brake");
  InputPort<PlantTruth> truth = input<PlantTruth>("truth");

  /// What has acted until the tick and, between ticks, what acts.
  OutputPort<DriveAction> acting = output<&SimulatedDrives::read>("acting", acting_);
  /// The drives are always powered; a robot that has come apart is a fault and disables them.
  OutputPort<StationStatus> status = output<&SimulatedDrives::report>("status", clock, acting_, truth);

 private:
  Update act_ = update<&SimulatedDrives::act>(Every{tick_}, acting_, clock, acting_, torque_command, brake);

  DriveAction act(Time now, const DriveAction& before, const TorqueCommand& command,
                  const BrakeCommand& brakes) const;
  void read(const DriveAction& now, DriveAction& out) const { out = now; }
  StationStatus report(Time now, const DriveAction& action, const PlantTruth& robot) const;
  DriveAction at_rest() const;
  void delay(const DriveAction& before, DriveAction& action, JointVector& mean) const;
  void spoil(Time now, const DriveAction& before, DriveAction& action) const;
};

}  // namespace flinch
