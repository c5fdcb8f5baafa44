#pragma once

#include <string>

#include "systems/robot/body_id.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// A fully-parallel robot: as many legs and drives as platform coordinates, each leg driven at its base and
/// coupled to the platform. This is all that a block may know of a mechanism, and all that a new one
/// implements.
///
/// An implementation is immutable, so one object serves many threads. All functions of motion neither throw
/// nor allocate; on input that they cannot serve (wrong size, not finite, out of reach) they return values
/// that are finite and marked invalid.
class ParallelRobot {
 public:
  virtual ~ParallelRobot() = default;

  virtual const std::string& name() const noexcept = 0;

  /// Number n of platform coordinates, equal to the number of drives.
  virtual int dof() const noexcept = 0;
  virtual int legs() const noexcept = 0;
  /// Number of Cartesian directions in which points move: 2 planar, 3 spatial.
  virtual int space_dimension() const noexcept = 0;

  /// Platform and both links of every leg; bodies are `BodyId::from_index(0 ... body_count() - 1)`.
  int body_count() const noexcept { return 1 + 2 * legs(); }

  /// Gravitational acceleration in the base frame [m/s^2], three components also for a planar robot.
  virtual Eigen::Vector3d gravity() const noexcept = 0;
  /// Radius of the platform's outline about the origin of E, body thickness included [m].
  virtual double platform_hull_radius() const noexcept = 0;
  /// Half the thickness of a link [m].
  virtual double link_radius() const noexcept = 0;
  /// Length of a link between its joints [m]; 0 for the platform.
  virtual double link_length(BodyId body) const noexcept = 0;

  /// A pose inside the workspace, and the working mode in which the robot is assembled there.
  virtual PlatformVector home_pose() const noexcept = 0;
  virtual WorkingMode home_working_mode() const noexcept = 0;

  /// a minus b on the manifold of poses: angles are wrapped to (-pi, pi].
  virtual PlatformVector difference(const PlatformVector& a, const PlatformVector& b) const noexcept = 0;
  /// a minus b, every entry wrapped to (-pi, pi]: difference of two sets of joint angles [rad].
  static JointVector joint_difference(const JointVector& a, const JointVector& b) noexcept;

  /// Joint angles that hold the platform at `pose`, elbows as in `mode`.
  virtual InverseSolution inverse_kinematics(const PlatformVector& pose,
                                             const WorkingMode& mode) const noexcept = 0;

  /// Pose from drive angles alone, by iteration from `start` until the drive angles agree to 1e-10 rad.
  virtual ForwardSolution forward_kinematics(const JointVector& active, const PlatformVector& start,
                                             const WorkingMode& mode) const noexcept = 0;
  /// Start of that iteration from active and passive angles: each leg followed to its coupling joint, the
  /// pose fitted through the tips. Exact for exact angles. [ICRA23] (3)
  virtual PlatformVector start_pose(const JointVector& active, const JointVector& passive) const noexcept = 0;
  /// Signs of the passive angles; an angle of exactly zero counts as +1. [ICRA23] II-A3
  virtual WorkingMode working_mode(const JointVector& passive) const noexcept = 0;
  /// Plausibility of the encoders: largest coordinate by which a leg's tip, followed from active and passive
  /// angles, misses its coupling joint on the platform at `pose` [m]. Infinite for unusable input.
  virtual double chain_closure_error(const JointVector& active, const JointVector& passive,
                                     const PlatformVector& pose) const noexcept = 0;

  /// Evaluates everything that depends on pose and velocity, elbows as in `mode`.
  virtual void kinematics(const PlatformVector& pose, const PlatformVector& velocity, const WorkingMode& mode,
                          Kinematics& out) const noexcept = 0;
  /// The same in the home working mode.
  void kinematics(const PlatformVector& pose, const PlatformVector& velocity,
                  Kinematics& out) const noexcept {
    kinematics(pose, velocity, home_working_mode(), out);
  }

  /// Equations of motion at the instant that `kinematics` describes.
  virtual void dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept = 0;

  /// A point given in body coordinates, in the base frame [m]. Zero for unreachable kinematics.
  virtual CartesianVector point_on_body(const Kinematics& kinematics, BodyId body,
                                        const CartesianVector& point_in_body) const noexcept = 0;
  /// Velocity map of that point. [SafePR] (3), [ICRA23] (4)-(6)
  virtual ContactJacobian contact_jacobian(const Kinematics& kinematics, BodyId body,
                                           const CartesianVector& point_in_body) const noexcept = 0;

  /// Body coordinates of the point at `fraction` of a link's axis, 0 at the proximal and 1 at the distal
  /// joint.
  CartesianVector axis_point(BodyId link, double fraction) const noexcept;
};

}  // namespace flinch
