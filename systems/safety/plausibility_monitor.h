#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/safety/current_monitor.h"
#include "systems/safety/imu_monitor.h"
#include "systems/safety/inertial_monitor.h"
#include "systems/safety/parity_monitor.h"
#include "systems/safety/response_monitor.h"
#include "systems/safety/rest_monitor.h"
#include "systems/safety/status_monitor.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/reset_command.h"
#include "systems/signals/station_status.h"

namespace flinch {

/// What the plausibility monitor remembers.
struct PlausibilityMemory {
  AngleMonitor angles;
  CurrentMonitor currents;
  InertialMonitor inertial;
  ImuMonitor imu;
  ParityMonitor parity;
  RestMonitor rest;
  StatusMonitor status;
  ResponseMonitor response;
  Time looked{};                             ///< the last tick at which anybody looked
  JointVector torque, torque_before;         ///< commanded in the two ticks before [Nm]; empty: none
  int free = 0;                              ///< ticks since the brakes have opened
  Time held_for{};                           ///< closed, before they were open
  bool moved = false;                        ///< they have been open before: nothing is learned any more
  int passive_seen = 0, imu_seen = 0;        ///< ticks with valid readings
  int passive_missing = 0, imu_missing = 0;  ///< ticks in a row without
  Plausibility found;
};

/// The long rings of what it remembers.
struct PlausibilityPast {
  InertialMonitor::Motions::Past points{};
  ImuMonitor::Past imu{};
  RestMonitor::Driven::Past driven{};
};

/// What the gate has done at the tick before.
struct GateAction {
  JointVector mean_torque;  ///< of all ticks since the monitor looked [Nm]; empty: one of them had none
  int ticks = 0;            ///< of these
  bool reset = false;       ///< the operator has reset at one of them but the first
  TorqueCommand torque;
  BrakeCommand brake;
  GateStatus status;
};

/// Asks sensors and drives those questions into which a contact cannot enter: current against command,
/// encoders against one another and against the IMU, an angle against what mass allows, a signal against its
/// own noise. What passes all and still disagrees with the model is a contact.
///
/// An inertial measurement unit that cannot be believed stops no robot: it is left out. `believed_imu`
/// passes on what can be believed of it.
///
/// It looks every millisecond, or every tick where ticks are longer: what contradicts itself shows in second
/// differences of angles, whose noise grows with the square of the rate. Meanwhile what it has found stands,
/// and the unit's samples wait: none is believed that was not looked at.
///
/// Noise, biases and offsets are learned while the brakes hold the robot before its first motion; what needs
/// them stays silent without.
class PlausibilityMonitor final : public System {
  static constexpr Time shortest_look = 1ms;
  Time look_;  ///< from look to look
  State<PlausibilityMemory> last_ = state<PlausibilityMemory>("last");
  State<PlausibilityPast> past_ = state<PlausibilityPast>("past");
  State<GateAction> done_ = state<GateAction>("done");

 public:
  /// Throws SetupError for limits that are not positive.
  PlausibilityMonitor(std::shared_ptr<const ParallelRobot> robot, const PlausibilityLimits& limits);

  InputPort<JointReading> joints = input<JointReading>("joints");
  InputPort<DriveReading> drives = input<DriveReading>("drives");
  InputPort<ImuReading> imu = input<ImuReading>("imu");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");
  InputPort<ResetCommand> reset = input<ResetCommand>("reset");
  InputPort<StationStatus> station = input<StationStatus>("station");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  // What the gate has done; seen at the next tick.
  InputPort<TorqueCommand> commanded = input<TorqueCommand>("commanded");
  InputPort<BrakeCommand> brake = input<BrakeCommand>("brake");
  InputPort<GateStatus> gate = input<GateStatus>("gate");

 private:
  Intermediate<PlausibilityMemory> now_ = intermediate<&PlausibilityMonitor::advance>(
      Every{look_}, "memory", clock, last_, past_, done_, joints, drives, imu, torque, reset, station,
      platform, kinematics, dynamics);

 public:
  OutputPort<Plausibility> plausibility = output<&PlausibilityMonitor::read>("plausibility", now_);
  OutputPort<ImuReading> believed_imu =
      output<&PlausibilityMonitor::pass_on>(Every{look_}, "believed_imu", now_, imu);

 private:
  Update remember_ = keep(Every{look_}, last_, now_);
  Update keep_ = update<&PlausibilityMonitor::keep_newest>(Every{look_}, past_, now_);
  Update note_ = update<&PlausibilityMonitor::note_action>(done_, clock, now_, commanded, brake, gate, reset);

  void advance(Time now, const PlausibilityMemory& last, const PlausibilityPast& past, const GateAction& done,
               const JointReading& angles, const DriveReading& currents, const ImuReading& inertial,
               const DriveTorque& acting, const ResetCommand& command, const StationStatus& status,
               const PlatformMotion& pose, const Kinematics& kinematic, const Dynamics& dynamic,
               PlausibilityMemory& next) const;
  void read(const PlausibilityMemory& memory, Plausibility& result) const { result = memory.found; }
  void pass_on(const PlausibilityMemory& memory, const ImuReading& said, ImuReading& believed) const {
    believed = said;
    believed.valid = said.valid && !memory.found.imu_left_out;
  }
  void keep_newest(const PlausibilityMemory& memory, PlausibilityPast& past) const {
    memory.inertial.motion.keep_in(past.points);
    memory.imu.motion.keep_in(past.imu.motion);
    memory.imu.errors.keep_in(past.imu.errors);
    memory.rest.driven.keep_in(past.driven);
  }
  void note_action(Time now, const PlausibilityMemory& memory, const TorqueCommand& torque,
                   const BrakeCommand& brakes, const GateStatus& status, const ResetCommand& command,
                   GateAction& done) const;

  std::shared_ptr<const ParallelRobot> robot_;
  PlausibilityLimits limits_;
  MountedImu mounted_;
};

}  // namespace flinch
