#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "systems/robot/legs/legs_model.h"
#include "systems/robot/legs/legs_parameters.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

struct LegsMotion;

/// Any parallel robot of a base, a platform and up to six legs, which are trees of joints that stand on the
/// base and close on the platform. Passive joints are those that are measured, in the order of the
/// description.
///
/// Working mode of a leg: 0 as at home; 1, of legs that ClosedForm calls arms, bent to the other side. det_B
/// is the product of the determinants of the legs' closures by those at home, 0 at a type-I singularity.
/// det_A is that of the drive map times det_B, by that at home: 0 at a type-II singularity, finite at type I.
class LegsRobot final : public ParallelRobot {
 public:
  /// Throws SetupError with all `problems(parameters)`.
  explicit LegsRobot(const LegsParameters& parameters);

  const LegsModel& model() const noexcept { return model_; }

  /// The same robot with the masses, inertia and friction of `model`, which differs in nothing else. They are
  /// not checked.
  std::shared_ptr<const LegsRobot> with(LegsModel model) const;

  int legs() const noexcept override { return static_cast<int>(model_.legs.size()); }
  int passive_joints() const noexcept override { return static_cast<int>(model_.measured.size()); }
  WorkingMode home_working_mode() const noexcept override;
  WorkingMode working_mode(const JointVector& passive) const noexcept override;
  InverseSolution inverse_kinematics(const Configuration& pose,
                                     const WorkingMode& mode) const noexcept override;
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
  /// Base parameters: friction, armatures, and moments of the platform, then of links from the base
  /// outwards, as far as motion tells them apart; what it does not is held as the robot has it.
  std::unique_ptr<const DynamicParameters> dynamic_parameters() const override;
  CartesianVector point_on_body(const Kinematics& kinematics, BodyId body,
                                const CartesianVector& point_in_body) const noexcept override;
  ContactJacobian contact_jacobian(const Kinematics& kinematics, BodyId body,
                                   const CartesianVector& point_in_body) const noexcept override;

 private:
  /// Ends of the axes of a leg's two bodies, in their frames.
  struct LegEnds {
    Eigen::Vector3d base_joint, passive_joint, coupling_joint;
  };
  /// The tip of a leg whose joints are all driven or measured, where they hold it, and what it is on the
  /// platform.
  struct Tip {
    Eigen::Vector3d held{0.0, 0.0, 0.0};
    Eigen::Vector3d on_platform{0.0, 0.0, 0.0};
  };

  LegsRobot(MechanismDescription description, LegsModel model);

  void find_ends();
  JointCounts joint_counts() const noexcept;
  bool is_usable(const Configuration& pose, const WorkingMode& mode) const noexcept;
  bool serves(const Kinematics& kinematics) const noexcept;
  bool serves(const Kinematics& kinematics, BodyId body, const CartesianVector& point) const noexcept;
  LegsState state_of(const Kinematics& kinematics) const noexcept;
  JointVector passive_positions(const LegsState& state) const noexcept;
  void set_points(const LegsMotion& motion, Kinematics& out) const noexcept;
  std::optional<Tip> tip_of(std::size_t leg, const JointVector& active,
                            const JointVector& passive) const noexcept;

  LegsModel model_;
  std::array<LegEnds, max_dof> ends_;
};

/// All that is wrong with `parameters`, each as one sentence that begins with the field: with their
/// description, and with the robot at home and around it.
std::vector<std::string> problems(const LegsParameters& parameters);

}  // namespace flinch
