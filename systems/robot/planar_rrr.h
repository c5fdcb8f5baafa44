#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

#include "systems/robot/parallel_robot.h"
#include "systems/robot/planar_motion.h"
#include "systems/robot/planar_rrr_parameters.h"

namespace flinch {

/// The planar 3-RRR of [SafePR], [ICRA23]: n = 3, platform coordinates (x, y, phi), singularities where a leg
/// is stretched or folded (type I) or the lines of the second links meet in one point or are parallel (type
/// II). Working mode of a leg: 0 where its passive angle is positive or zero, 1 where it is negative.
class PlanarRrr final : public ParallelRobot {
 public:
  /// Throws SetupError with all `problems(parameters)`.
  explicit PlanarRrr(const PlanarRrrParameters& parameters);

  const PlanarRrrParameters& parameters() const noexcept { return parameters_; }

  int legs() const noexcept override { return 3; }
  int passive_joints() const noexcept override { return 3; }
  WorkingMode home_working_mode() const noexcept override;
  WorkingMode working_mode(const JointVector& passive) const noexcept override;
  std::shared_ptr<const ParallelRobot> assembled_as(const WorkingMode& mode) const override;
  InverseSolution inverse_kinematics(const Configuration& pose,
                                     const WorkingMode& mode) const noexcept override;
  ForwardSolution forward_kinematics(const JointVector& active, const Configuration& start,
                                     const WorkingMode& mode) const noexcept override;
  std::optional<PlatformVector> platform_velocity(const Configuration& pose, const JointVector& drive_rates,
                                                  const WorkingMode& mode) const noexcept override;
  Configuration start_pose(const JointVector& active, const JointVector& passive) const noexcept override;
  double chain_closure_error(const JointVector& active, const JointVector& passive,
                             const Configuration& pose) const noexcept override;

  using ParallelRobot::kinematics;
  void kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                  Kinematics& out) const noexcept override;
  void dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept override;
  std::optional<JointVector> drive_acceleration(const Configuration& pose, const PlatformVector& velocity,
                                                const JointVector& drive_torques) const noexcept override;
  DryFriction dry_friction(int drive) const noexcept override;
  std::shared_ptr<const Mechanism> deviating(const RobotDeviation& deviation) const override;
  std::unique_ptr<const DynamicParameters> dynamic_parameters() const override;
  CartesianVector point_on_body(const Kinematics& kinematics, BodyId body,
                                const CartesianVector& point_in_body) const noexcept override;
  ContactJacobian contact_jacobian(const Kinematics& kinematics, BodyId body,
                                   const CartesianVector& point_in_body) const noexcept override;

  void place(const Configuration& pose, PlaceKinematics& out) const noexcept override;
  std::optional<DeterminantGradients> determinant_gradients(
      const Kinematics& kinematics) const noexcept override;
  SelfCollisionTasks self_collision_tasks(const Kinematics& kinematics,
                                          double distance) const noexcept override;

  // ------------------------------------------------ fixed-size path for simulation, home working mode

  /// Legs closed at a pose, their Jacobians and rates.
  PlanarMotion motion(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) const noexcept;
  void motion(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity, PlanarMotion& out) const noexcept;

  /// All joint angles of a reachable motion.
  JointAngles joint_angles(const PlanarMotion& motion) const noexcept;

  /// As chain_closure_error of those angles, by the directions of the links instead [m].
  double chain_closure_error(const PlanarMotion& motion) const noexcept;

  /// Forward dynamics [m/s^2, m/s^2, rad/s^2] of a reachable motion under `drive_torques` [Nm] and an
  /// external platform wrench [N, N, Nm]. Regular at type-II singularities too.
  Eigen::Vector3d acceleration(const PlanarMotion& motion, const Eigen::Vector3d& drive_torques,
                               const Eigen::Vector3d& external_wrench) const noexcept;

  /// Accelerations of the drives [rad/s^2] in a reachable motion whose platform has this `acceleration`.
  Eigen::Vector3d drive_accelerations(const PlanarMotion& motion,
                                      const Eigen::Vector3d& acceleration) const noexcept;

  /// `acceleration` from pose and velocity; nothing if the pose is out of reach or not finite.
  std::optional<Eigen::Vector3d> acceleration(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity,
                                              const Eigen::Vector3d& drive_torques,
                                              const Eigen::Vector3d& external_wrench) const noexcept;

  /// Kinetic energy of a reachable motion, summed over links, rotors and platform [J].
  double kinetic_energy(const PlanarMotion& motion) const noexcept;

  /// Power that friction takes from a reachable motion [W], never negative.
  double friction_power(const PlanarMotion& motion) const noexcept;

 private:
  using ElbowSigns = std::array<double, 3>;
  using Legs = std::array<PlanarLeg, 3>;

  void motion(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity, const ElbowSigns& signs,
              PlanarMotion& out) const noexcept;
  ForwardSolution solve_lengths(const Eigen::Vector3d& active, Eigen::Vector3d pose,
                                const ElbowSigns& signs) const noexcept;
  ForwardSolution solve_angles(const Eigen::Vector3d& active, Eigen::Vector3d pose,
                               const ElbowSigns& signs) const noexcept;
  std::optional<Legs> close_legs(const Eigen::Vector3d& pose, const ElbowSigns& signs) const noexcept;
  JointAngles joint_angles(double phi, const std::array<const PlanarLeg*, 3>& legs) const noexcept;
  Eigen::Vector3d active_error(const JointVector& active, const PlanarMotion& motion) const noexcept;

  PlanarRrrParameters parameters_;
  std::array<PlanarLegGeometry, 3> geometry_;
  ElbowSigns home_signs_;
};

}  // namespace flinch
