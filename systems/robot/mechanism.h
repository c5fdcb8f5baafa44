#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "systems/robot/body.h"
#include "systems/robot/body_id.h"
#include "systems/robot/configuration_space.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/determinant_gradients.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/joint_friction.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/place_kinematics.h"
#include "systems/robot/self_collision_tasks.h"
#include "systems/robot/vectors.h"

namespace flinch {

struct MotionEquations;
struct RobotDeviation;

/// How a drive moves: an angle [rad] with a torque [Nm], or a length [m] with a force [N].
enum class DriveKind { revolute, prismatic };

/// What does not change of a mechanism.
struct MechanismDescription {
  std::string name;
  ConfigurationSpace space;       ///< Of its configurations.
  std::vector<DriveKind> drives;  ///< One entry a drive, at most `max_dof`.
  std::vector<Body> bodies;       ///< By `BodyId::index()`: the platform first.
  /// Bodies whose distance is watched; neighbours, which always touch, are not among them.
  std::vector<BodyPair> self_collision_pairs;
  std::vector<BesidePlatform> beside_platform = {};  ///< Links that may run into the platform.
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};          ///< In the base frame [m/s^2].
  Configuration home_pose;                           ///< In the middle of the workspace.
  /// Stated with the condition number: length that makes an angle comparable to a distance [m].
  double characteristic_length = 1.0;
};

/// What moves: bodies whose configuration follows from that of a platform, moved by drives. This is all that
/// observers, control laws and plants know of a robot.
///
/// An implementation is immutable, so one object serves many threads. All functions of motion neither throw
/// nor allocate; on input that they cannot serve (wrong size, not finite, out of reach) they return values
/// that are finite and marked invalid.
class Mechanism {
 public:
  virtual ~Mechanism() = default;

  const MechanismDescription& description() const noexcept { return description_; }
  const std::string& name() const noexcept { return description_.name; }

  const ConfigurationSpace& space() const noexcept { return description_.space; }
  /// n: entries of a velocity or wrench.
  int dof() const noexcept { return space().dimension(); }
  /// Number of Cartesian directions in which points move: 2 planar, 3 spatial.
  int space_dimension() const noexcept { return space().translations(); }

  int drives() const noexcept { return static_cast<int>(description_.drives.size()); }
  DriveKind drive_kind(int drive) const noexcept {
    return description_.drives[static_cast<std::size_t>(drive)];
  }
  int body_count() const noexcept { return static_cast<int>(description_.bodies.size()); }
  const Body& body(BodyId body) const noexcept {
    return description_.bodies[static_cast<std::size_t>(body.index())];
  }
  const Eigen::Vector3d& gravity() const noexcept { return description_.gravity; }
  const Configuration& home_pose() const noexcept { return description_.home_pose; }

  /// a minus b on the manifold of configurations.
  PlatformVector difference(const Configuration& a, const Configuration& b) const noexcept {
    return space().difference(a, b);
  }
  /// a minus b of two sets of drive positions; angles are wrapped to (-pi, pi]. Zero for wrong sizes.
  JointVector drive_difference(const JointVector& a, const JointVector& b) const noexcept;

  /// Evaluates everything that depends on pose and velocity, assembled as at home.
  virtual void kinematics(const Configuration& pose, const PlatformVector& velocity,
                          Kinematics& out) const noexcept = 0;

  /// Equations of motion at the instant that `kinematics` describes.
  virtual void dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept = 0;

  /// What an integration of the motion needs at an instant, in one go: the equations, and the kinematics
  /// without what follows from the inverse of the drive map. The same as kinematics() and dynamics() say, to
  /// rounding; these two, unless a mechanism has something faster.
  virtual void equations_of_motion(const Configuration& pose, const PlatformVector& velocity,
                                   Kinematics& kinematics, MotionEquations& equations) const noexcept;

  /// How the rates of the drives change under their efforts [Nm or N] while nothing else acts, at `pose` and
  /// `velocity`: J_qa,x dv + dJ_qa,x v [rad/s^2 or m/s^2]. Nothing where that cannot be said.
  virtual std::optional<JointVector> drive_acceleration(const Configuration& pose,
                                                        const PlatformVector& velocity,
                                                        const JointVector& drive_efforts) const noexcept;

  /// A point given in body coordinates, in the base frame [m]. Zero for unreachable kinematics.
  virtual CartesianVector point_on_body(const Kinematics& kinematics, BodyId body,
                                        const CartesianVector& point_in_body) const noexcept = 0;
  /// Velocity map of that point. [SafePR] (3), [ICRA23] (4)-(6)
  virtual ContactJacobian contact_jacobian(const Kinematics& kinematics, BodyId body,
                                           const CartesianVector& point_in_body) const noexcept = 0;

  /// Dry friction in the joint of a drive; none, unless a mechanism says so.
  virtual DryFriction dry_friction(int drive) const noexcept;

  /// The same robot with these differences; null where a mechanism cannot be made to differ.
  virtual std::shared_ptr<const Mechanism> deviating(const RobotDeviation& deviation) const;

  /// That part of the kinematics which limits of the place need, assembled as at home.
  virtual void place(const Configuration& pose, PlaceKinematics& out) const noexcept;
  /// In closed form; nothing where there is none, or where `kinematics` is not valid.
  virtual std::optional<DeterminantGradients> determinant_gradients(
      const Kinematics& kinematics) const noexcept;
  /// What keeps links `distance` [m] apart; none where there is no such form, or it is not exact.
  virtual SelfCollisionTasks self_collision_tasks(const Kinematics& kinematics,
                                                  double distance) const noexcept;

  /// Least gap between the surfaces of the platform and of what is `beside_platform` [m]; 0 where they
  /// overlap, infinite where nothing is. Of reachable kinematics.
  virtual double platform_gap(const Kinematics& kinematics) const noexcept;

  /// Body coordinates of the point at `fraction` of the axis of a body's first capsule; the origin for a body
  /// that is none.
  CartesianVector axis_point(BodyId body, double fraction) const noexcept;

 protected:
  explicit Mechanism(MechanismDescription description) : description_(std::move(description)) {}

 private:
  MechanismDescription description_;
};

}  // namespace flinch
