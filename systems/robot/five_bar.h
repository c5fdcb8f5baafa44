#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

#include "systems/robot/five_bar_parameters.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/planar_leg.h"

namespace flinch {

/// A planar five-bar: n = 2, platform coordinates (x, y) of the point in which its two legs meet. It has no
/// orientation, and forces on it have no moment. Singular where a leg is stretched or folded (type I) or the
/// second links are in line (type II). Working mode of a leg: 0 where its passive angle is positive or zero,
/// 1 where it is negative. det_A and det_B are those of |p - elbow|^2 - l2^2 = 0 by position and drives.
class FiveBar final : public ParallelRobot {
 public:
  /// Throws SetupError with all `problems(parameters)`.
  explicit FiveBar(const FiveBarParameters& parameters);

  const FiveBarParameters& parameters() const noexcept { return parameters_; }

  int legs() const noexcept override { return 2; }
  int passive_joints() const noexcept override { return 2; }
  WorkingMode home_working_mode() const noexcept override;
  WorkingMode working_mode(const JointVector& passive) const noexcept override;
  std::shared_ptr<const ParallelRobot> assembled_as(const WorkingMode& mode) const override;
  InverseSolution inverse_kinematics(const Configuration& pose,
                                     const WorkingMode& mode) const noexcept override;
  /// In closed form, on the side of the elbows on which `start` lies, which must be in reach.
  ForwardSolution forward_kinematics(const JointVector& active, const Configuration& start,
                                     const WorkingMode& mode) const noexcept override;
  Configuration start_pose(const JointVector& active, const JointVector& passive) const noexcept override;
  double chain_closure_error(const JointVector& active, const JointVector& passive,
                             const Configuration& pose) const noexcept override;

  using ParallelRobot::kinematics;
  void kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                  Kinematics& out) const noexcept override;
  void dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept override;
  DryFriction dry_friction(int drive) const noexcept override;
  std::shared_ptr<const Mechanism> deviating(const RobotDeviation& deviation) const override;
  std::unique_ptr<const DynamicParameters> dynamic_parameters() const override;
  CartesianVector point_on_body(const Kinematics& kinematics, BodyId body,
                                const CartesianVector& point_in_body) const noexcept override;
  ContactJacobian contact_jacobian(const Kinematics& kinematics, BodyId body,
                                   const CartesianVector& point_in_body) const noexcept override;

 private:
  using Legs = std::array<PlanarLeg, 2>;

  std::optional<Legs> close_legs(const Eigen::Vector2d& point, const WorkingMode& mode) const noexcept;
  JointAngles joint_angles(const Legs& legs) const noexcept;

  FiveBarParameters parameters_;
  std::array<PlanarLegGeometry, 2> geometry_;
};

}  // namespace flinch
