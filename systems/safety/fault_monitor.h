#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/safety/fault_table.h"
#include "systems/safety/recovery_monitor.h"

namespace flinch {

/// What the fault monitor remembers.
struct FaultMonitorMemory {
  static constexpr Time never = -24h;
  Time station = never;  ///< ticks of the last usable samples
  Time joints = never;
  Time drives = never;
  TorqueCommand last_command;
  TorqueCommand command;
  EncoderMonitor encoders;
  RecoveryMonitor recovery;
};

/// Looks for every fault of the fault table, every tick, for the torque gate, and says which of them a
/// recovery bears.
class FaultMonitor final : public System {
  State<FaultMonitorMemory> last_ = state<FaultMonitorMemory>("last");

 public:
  /// Throws SetupError with every limit that could not be kept.
  FaultMonitor(std::shared_ptr<const ParallelRobot> robot, const FaultLimits& limits);

  InputPort<TickTiming> timing = input<TickTiming>("timing");  ///< of this tick in a real-time run
  InputPort<StationStatus> station = input<StationStatus>("station");
  InputPort<JointReading> joints = input<JointReading>("joints");
  InputPort<DriveReading> drives = input<DriveReading>("drives");
  InputPort<JointMotion> motion = input<JointMotion>("motion");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");  ///< of that platform
  InputPort<WorkspaceMeasures> measures = input<WorkspaceMeasures>("measures");
  InputPort<ContactDetection> detection = input<ContactDetection>("detection");
  InputPort<PlatformReference> reference = input<PlatformReference>("reference");  ///< that is being followed
  InputPort<TorqueCommand> command = input<TorqueCommand>("command");
  InputPort<OperatorCommand> buttons = input<OperatorCommand>("buttons");
  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<Plausibility> plausibility = input<Plausibility>("plausibility");  ///< of these readings
  InputPort<DriveCheckStatus> drive_check = input<DriveCheckStatus>("drive_check");

 private:
  Intermediate<FaultMonitorMemory> now_ =
      intermediate<&FaultMonitor::advance>("memory", clock, last_, station, joints, drives, motion, platform,
                                           kinematics, measures, command, reaction);

 public:
  OutputPort<FaultReport> faults = output<&FaultMonitor::judge>(
      "faults", clock, now_, timing, station, joints, drives, motion, platform, measures, detection,
      reference, buttons, reaction, plausibility, drive_check);

 private:
  Update remember_ = keep(last_, now_);

  void advance(Time now, const FaultMonitorMemory& last, const StationStatus& status,
               const JointReading& angles, const DriveReading& currents, const JointMotion& rates,
               const PlatformMotion& pose, const Kinematics& kinematic, const WorkspaceMeasures& workspace,
               const TorqueCommand& asked, const ReactionState& state, FaultMonitorMemory& next) const;
  FaultReport judge(Time now, const FaultMonitorMemory& memory, const TickTiming& tick,
                    const StationStatus& status, const JointReading& angles, const DriveReading& currents,
                    const JointMotion& rates, const PlatformMotion& pose, const WorkspaceMeasures& workspace,
                    const ContactDetection& contact, const PlatformReference& followed,
                    const OperatorCommand& pressed, const ReactionState& state, const Plausibility& plausible,
                    const DriveCheckStatus& checked) const;

  /// det A positive on the side of its singularity on which the home pose lies.
  WorkspaceMeasures seen_from_home(WorkspaceMeasures seen) const;

  std::shared_ptr<const ParallelRobot> robot_;
  FaultLimits limits_;
  double home_side_ = 1.0;  ///< the sign of det A at home
};

}  // namespace flinch
