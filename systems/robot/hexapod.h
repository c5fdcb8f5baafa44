#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "systems/robot/body_dynamics.h"
#include "systems/robot/hexapod_parameters.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/universal_leg.h"

namespace flinch {

/// A hexapod 6-UPS, or Gough-Stewart platform: n = 6, platform coordinates a pose in space, six drives that
/// lengthen the legs. Every leg can be assembled in one way only, so its working mode is 0, and no passive
/// joint carries an encoder. Leg points: base joint, end of the cylinder, platform joint.
///
/// det_A is the determinant of the map from velocity to leg rates, with angles counted at the characteristic
/// length; it is 0 at a type-II singularity. det_B is the product over the legs of the squared sine of the
/// angle from the universal joint's first axis to the leg; it is 0 where a leg lies along that axis (type I).
class Hexapod final : public ParallelRobot {
 public:
  /// Throws SetupError with all `problems(parameters)`.
  explicit Hexapod(const HexapodParameters& parameters);

  const HexapodParameters& parameters() const noexcept { return parameters_; }

  int legs() const noexcept override { return 6; }
  int passive_joints() const noexcept override { return 0; }
  WorkingMode home_working_mode() const noexcept override;
  WorkingMode working_mode(const JointVector& passive) const noexcept override;
  InverseSolution inverse_kinematics(const Configuration& pose,
                                     const WorkingMode& mode) const noexcept override;
  ForwardSolution forward_kinematics(const JointVector& active, const Configuration& start,
                                     const WorkingMode& mode) const noexcept override;
  /// The home pose: nothing but the drives is measured.
  Configuration start_pose(const JointVector& active, const JointVector& passive) const noexcept override;
  /// 0 for usable input: without passive encoders no chain can contradict the pose.
  double chain_closure_error(const JointVector& active, const JointVector& passive,
                             const Configuration& pose) const noexcept override;

  double platform_gap(const Kinematics& kinematics) const noexcept override;

  using ParallelRobot::kinematics;
  void kinematics(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
                  Kinematics& out) const noexcept override;
  void dynamics(const Kinematics& kinematics, Dynamics& out) const noexcept override;
  void equations_of_motion(const Configuration& pose, const PlatformVector& velocity, Kinematics& kinematics,
                           MotionEquations& equations) const noexcept override;
  DryFriction dry_friction(int drive) const noexcept override;
  std::shared_ptr<const Mechanism> deviating(const RobotDeviation& deviation) const override;
  std::unique_ptr<const DynamicParameters> dynamic_parameters() const override;
  CartesianVector point_on_body(const Kinematics& kinematics, BodyId body,
                                const CartesianVector& point_in_body) const noexcept override;
  ContactJacobian contact_jacobian(const Kinematics& kinematics, BodyId body,
                                   const CartesianVector& point_in_body) const noexcept override;

 private:
  using Twist = Eigen::Matrix<double, 6, 1>;
  using Row = Eigen::Matrix<double, 1, 6>;
  using Map = Eigen::Matrix<double, 3, 6>;

  /// Position of the platform, its axes, and its velocity.
  struct Platform {
    Eigen::Vector3d origin;
    Eigen::Matrix3d axes;
    Twist velocity;
  };
  /// A leg at a pose: r = R b, the unit vector s along the leg, its length q.
  struct Leg {
    Eigen::Vector3d arm;
    Eigen::Vector3d direction;
    double length = 0.0;
    double sine_squared = 0.0;  ///< Of the angle from the universal joint's first axis to the leg.
  };
  /// How it moves: rates, and the row that maps the platform's velocity to the rate of its length.
  struct LegRates {
    Eigen::Vector3d direction_rate;
    double length_rate = 0.0;
    Row row, row_rate;
  };

  struct MovingLeg {
    Leg leg;
    LegRates rates;
  };
  /// The whole at an instant.
  struct Closed {
    Platform platform;
    std::array<MovingLeg, 6> legs;
  };
  /// M and h of MotionEquations.
  struct Equations {
    Eigen::Matrix<double, 6, 6> M;
    Twist h;
  };

  /// Platform, legs, joints and the drive map; false, and `out` unreachable, where that cannot be.
  bool close(const Configuration& pose, const PlatformVector& velocity, const WorkingMode& mode,
             Closed& closed, Kinematics& out) const noexcept;
  /// Of the platform, with what is fixed to it.
  Equations platform_equations(const Platform& platform) const noexcept;
  /// Adds those of a leg, friction included.
  void add_leg(std::size_t index, const MovingLeg& moving, const Platform& platform,
               Equations& sum) const noexcept;
  static Platform platform(const Configuration& pose, const Twist& velocity) noexcept;
  Leg leg(std::size_t index, const Platform& platform) const noexcept;
  static LegRates rates(const Leg& leg, const Platform& platform) noexcept;
  /// Maps from v to the velocity of the joint between leg and platform; as platform_motion().point(), without
  /// products by zeros and ones.
  static PointMotion<6> joint_motion(const Leg& leg, const Platform& platform) noexcept;
  UniversalLeg<6> universal(std::size_t index, const Leg& leg, const LegRates& rates,
                            const PointMotion<6>& joint) const noexcept;
  static BodyMotion<6> platform_motion(const Platform& platform) noexcept;
  BodyMotion<6> cylinder_motion(std::size_t index, const UniversalLeg<6>& leg) const noexcept;
  static BodyMotion<6> rod_motion(const Leg& leg, const PointMotion<6>& joint,
                                  const UniversalLeg<6>& universal, const Platform& platform) noexcept;
  BodyMotion<6> motion(BodyId body, const Platform& platform) const noexcept;
  bool reaches(const Leg& leg) const noexcept;
  bool serves(const Kinematics& kinematics, BodyId body, const CartesianVector& point) const noexcept;

  HexapodParameters parameters_;
  std::array<double, 6> held_stretches_;  ///< Of the rods, see hexapod_outline.h [m].
  RigidBodyInertia loaded_platform_;
  std::array<RigidBodyInertia, 6> cylinders_;
  std::array<RigidBodyInertia, 6> rods_;
  Eigen::Matrix3d platform_inertia_;             ///< Loaded, about the origin of E, in its axes.
  std::array<Eigen::Matrix3d, 6> link_inertia_;  ///< Of both links, each about its own joint, in their axes.
  Twist scale_;  ///< Of the columns of the drive map: 1 for translations, 1 / characteristic length.
};

}  // namespace flinch
