#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "systems/robot/five_bar_parameters.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/planar_leg.h"

/// A mechanism of your own: a point in the plane held by three legs of two links, each driven at its base. It
/// has more drives than coordinates, as no robot of the library has. A five-bar has two of these legs, and
/// what flinch knows of such a leg is used: systems/robot/planar_leg.h, planar_leg_dynamics.h. All else is
/// written out, as it has to be for a mechanism that is like none of the library.
///
/// det_A is sqrt(det(A^T A)), A of |p - elbow|^2 - l2^2 = 0 by position: it has no sign, and is 0 where all
/// second links are in line. det_B is as in a five-bar.
class PointOnThreeLegs final : public flinch::ParallelRobot {
 public:
  static constexpr int leg_count = 3;

  struct Parameters {
    std::array<flinch::FiveBarLeg, leg_count> legs;
    double platform_mass = 0.0;           ///< in the point where the legs meet [kg]
    Eigen::Vector2d home_pose{0.0, 0.0};  ///< (x, y) [m]
  };

  /// Throws SetupError with all `problems(parameters)`.
  explicit PointOnThreeLegs(const Parameters& parameters);

  int legs() const noexcept override { return leg_count; }
  int passive_joints() const noexcept override { return leg_count; }
  flinch::WorkingMode home_working_mode() const noexcept override;
  flinch::WorkingMode working_mode(const flinch::JointVector& passive) const noexcept override;
  flinch::InverseSolution inverse_kinematics(const flinch::Configuration& pose,
                                             const flinch::WorkingMode& mode) const noexcept override;
  /// The pose that fits all drives best: encoders of three drives never agree quite about two coordinates.
  /// Converged where each agrees to 0.01 rad.
  flinch::ForwardSolution forward_kinematics(const flinch::JointVector& active,
                                             const flinch::Configuration& start,
                                             const flinch::WorkingMode& mode) const noexcept override;
  flinch::Configuration start_pose(const flinch::JointVector& active,
                                   const flinch::JointVector& passive) const noexcept override;
  double chain_closure_error(const flinch::JointVector& active, const flinch::JointVector& passive,
                             const flinch::Configuration& pose) const noexcept override;

  using flinch::ParallelRobot::kinematics;
  void kinematics(const flinch::Configuration& pose, const flinch::PlatformVector& velocity,
                  const flinch::WorkingMode& mode, flinch::Kinematics& out) const noexcept override;
  void dynamics(const flinch::Kinematics& kinematics, flinch::Dynamics& out) const noexcept override;
  flinch::DryFriction dry_friction(int drive) const noexcept override;
  std::shared_ptr<const flinch::Mechanism> deviating(const flinch::RobotDeviation& deviation) const override;
  flinch::CartesianVector point_on_body(const flinch::Kinematics& kinematics, flinch::BodyId body,
                                        const flinch::CartesianVector& point_in_body) const noexcept override;
  flinch::ContactJacobian contact_jacobian(
      const flinch::Kinematics& kinematics, flinch::BodyId body,
      const flinch::CartesianVector& point_in_body) const noexcept override;

 private:
  using Legs = std::array<flinch::PlanarLeg, leg_count>;

  std::optional<Legs> close_legs(const flinch::Configuration& pose,
                                 const flinch::WorkingMode& mode) const noexcept;
  flinch::JointAngles joint_angles(const Legs& legs) const noexcept;

  Parameters parameters_;
  std::array<flinch::PlanarLegGeometry, leg_count> geometry_;
};

/// All that is wrong with `parameters`, one sentence each that begins with the field.
std::vector<std::string> problems(const PointOnThreeLegs::Parameters& parameters);

/// Legs of the five-bar of the library and a third one opposite to them.
PointOnThreeLegs::Parameters point_on_three_legs();
