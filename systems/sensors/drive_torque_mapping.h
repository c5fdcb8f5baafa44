#pragma once

#include <array>
#include <memory>
#include <optional>

#include "systems/framework/system.h"
#include "systems/robot/cogging.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/parallel_robot.h"
#include "systems/sensors/first_order_low_pass.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/sampling.h"
#include "systems/signals/station_status.h"

namespace flinch {

struct DriveTorqueSettings {
  /// k_t of each drive [Nm/A or N/A]; empty: as default_drives() says, until calibrated.
  JointVector torque_constant;
  Sampling sampling;
  Cogging cogging{};    ///< As far as it is known [Nm or N].
  JointVector delay{};  ///< By which the torque of each drive is behind its current [s]; empty: none.
};

/// Cogging where the drives last were, and its mean on the way there [Nm or N]; empty: nothing is known.
struct PassedCogging {
  JointVector here;
  JointVector mean;
};

/// The last usable currents, and those that make the torques of the interval until then [A]; empty: none.
struct DelayedCurrent {
  Time acquired{};
  JointVector measured;
  JointVector acting;
  std::array<JointVector, most_delayed> earlier;  ///< measured before, the latest first; empty: none
};

/// What the mapping remembers: its last sample.
struct DriveTorqueMemory {
  Time acquired{};
  Time arrived{};  ///< tick at which it was read
  DelayedCurrent current;
  LowPassMemory torque;
  PassedCogging cogging;
};

/// tau_a = k_t i, each drive with its own constant, [SafePR] V-A, and its cogging where that is known.
///
/// Aligned, the torque lags exactly as the velocity does. The current that is read at t_k tells the torque of
/// the interval (t_{k-1}, t_k], over which the drive held it: its mean m_k there. The velocity filter sees
/// the mean velocity d_k of the same interval. Under piecewise constant acceleration a_k,
///   (d_k - d_{k-1}) / T = (a_k + a_{k-1}) / 2,
/// so that both, sent through the same filter, still obey it: the change of the filtered momentum over a step
/// is the mean of the filtered torques at its two ends (`TorqueTiming::sampled` of the momentum observers).
///
/// Where the torque of a drive is known to be behind its current, by lambda, the current that acts is
///   i_k - lambda (i_k - i_{k-1}) / T,
/// as if it changed evenly. Where lambda is longer than T, it lies between two before. After a gap it is that
/// which is read.
///
/// Cogging follows from where the drive is: its mean over the interval is that of its two ends. (Derived.)
/// While the encoders say nothing it stays as it was.
///
/// Not valid where the reading is not, or is not finite or of the wrong size. Nothing is held: what may live
/// on old torques decides so itself. Only the low pass outlives missing samples, for the longest hold. It
/// begins anew when the brakes open: what they held, the drives hold from one tick to the next.
class DriveTorqueMapping final : public System {
  State<DriveTorqueMemory> memory_ = state<DriveTorqueMemory>("memory");

 public:
  /// `aligned_with`: the low pass of the velocity with which the torque is aligned; none: the torque as it
  /// is. Throws SetupError unless there is a positive torque constant for each drive, and cogging and delay
  /// of all or of none.
  DriveTorqueMapping(const std::shared_ptr<const ParallelRobot>& robot, const DriveTorqueSettings& settings,
                     const std::optional<LowPassSettings>& aligned_with = std::nullopt);

  InputPort<JointReading> joints = input<JointReading>("joints");  ///< for the cogging
  InputPort<DriveReading> drives = input<DriveReading>("drives");
  InputPort<StationStatus> status = input<StationStatus>("status");  ///< for the brakes

 private:
  Intermediate<DriveTorqueMemory> next_ =
      intermediate<&DriveTorqueMapping::advance>("next", joints, drives, status, memory_, clock);

 public:
  OutputPort<DriveTorque> torque = output<&DriveTorqueMapping::read>("torque", drives, status, next_);

 private:
  void advance(const JointReading& encoders, const DriveReading& reading, const StationStatus& station,
               const DriveTorqueMemory& memory, Time now, DriveTorqueMemory& next) const;
  void read(const DriveReading& reading, const StationStatus& station, const DriveTorqueMemory& next,
            DriveTorque& result) const;
  bool is_usable(const DriveReading& reading) const;
  DelayedCurrent delayed(const DriveReading& reading, const DelayedCurrent& last) const;
  PassedCogging passed(const JointReading& encoders, const PassedCogging& last) const;
  JointVector torque_of(const DriveReading& reading, const DriveTorqueMemory& next) const;

  JointVector torque_constant_;
  Cogging cogging_;
  JointVector delay_;
  Sampling sampling_;
  std::optional<FirstOrderLowPass> low_pass_;
};

}  // namespace flinch
