#pragma once

#include <memory>
#include <optional>

#include "systems/robot/mechanism.h"

namespace flinch {

class DynamicParameters;

/// A fully-parallel robot: legs that are driven and coupled to one platform. It refines a mechanism by what
/// only such a robot has: passive joints that may carry encoders, working modes, and a pose that must be
/// found from the drives.
class ParallelRobot : public Mechanism {
 public:
  virtual int legs() const noexcept = 0;
  /// Entries of a reading of the passive encoders; 0 where passive joints are never measured.
  virtual int passive_joints() const noexcept = 0;

  /// The working mode in which the robot is assembled at home: one index a leg, see `WorkingMode`.
  virtual WorkingMode home_working_mode() const noexcept = 0;
  /// The working mode that passive angles show. [ICRA23] II-A3 That at home where they show none.
  virtual WorkingMode working_mode(const JointVector& passive) const noexcept = 0;

  /// The same robot assembled at home as in `mode`; null where it has no other way.
  virtual std::shared_ptr<const ParallelRobot> assembled_as(const WorkingMode& /*mode*/) const {
    return nullptr;
  }

  /// Joint positions that hold the platform at `pose`, assembled as in `mode`.
  virtual InverseSolution inverse_kinematics(const Configuration& pose,
                                             const WorkingMode& mode) const noexcept = 0;

  /// Pose from the drives alone, by iteration from `start` until they agree to 1e-10 rad or m; of more drives
  /// than coordinates, which never agree quite, the pose that fits them best.
  virtual ForwardSolution forward_kinematics(const JointVector& active, const Configuration& start,
                                             const WorkingMode& mode) const noexcept = 0;
  /// Velocity of the platform at `pose` from the rates of the drives; nothing where it does not follow from
  /// them, because the pose is out of reach or singular.
  virtual std::optional<PlatformVector> platform_velocity(const Configuration& pose,
                                                          const JointVector& drive_rates,
                                                          const WorkingMode& mode) const noexcept;
  /// Start of that iteration from active and passive joints: each leg followed to its coupling joint, the
  /// pose fitted through the tips. Exact for exact readings; the home pose without passive joints.
  /// [ICRA23] (3)
  virtual Configuration start_pose(const JointVector& active, const JointVector& passive) const noexcept = 0;
  /// Plausibility of the encoders: largest coordinate by which a leg's tip, followed from active and passive
  /// joints, misses its coupling joint on the platform at `pose` [m]. Infinite for unusable input.
  virtual double chain_closure_error(const JointVector& active, const JointVector& passive,
                                     const Configuration& pose) const noexcept = 0;
  /// a minus b of two readings of the passive encoders, every entry wrapped to (-pi, pi] [rad].
  static JointVector passive_difference(const JointVector& a, const JointVector& b) noexcept;

  /// Masses, moments and friction that can be calibrated; null where none are known.
  virtual std::unique_ptr<const DynamicParameters> dynamic_parameters() const;

  using Mechanism::kinematics;
  /// Evaluates everything that depends on pose and velocity, assembled as in `mode`.
  virtual void kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                          Kinematics& out) const noexcept = 0;
  void kinematics(const Configuration& pose, const PlatformVector& velocity,
                  Kinematics& out) const noexcept override {
    kinematics(pose, velocity, home_working_mode(), out);
  }

 protected:
  using Mechanism::Mechanism;
};

}  // namespace flinch
