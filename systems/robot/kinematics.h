#pragma once

#include <array>
#include <limits>

#include "systems/robot/configuration_space.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Positions of all joints [rad or m]; angles in (-pi, pi]. The mechanism says from where they count. Passive
/// and coupling joints are there as far as encoders may sit on them; otherwise these are empty.
struct JointAngles {
  JointVector active;    ///< q_a: one entry a drive.
  JointVector passive;   ///< q_p: of planar legs the elbow, second link relative to the first.
  JointVector coupling;  ///< q_c: of planar legs the platform relative to the second link.
};

/// Time derivatives of `JointAngles` [rad/s or m/s].
struct JointRates {
  JointVector active;
  JointVector passive;
  JointVector coupling;
};

/// Ends of a leg's links in the base frame [m]. The first link is the segment from base to passive joint, the
/// second from passive to coupling joint; links that slide in one another overlap in between.
struct LegPoints {
  CartesianVector base_joint;
  CartesianVector passive_joint;
  CartesianVector coupling_joint;
};

/// Joint angles that hold the platform at a pose. Unreachable: `reachable` is false and all angles are zero.
struct InverseSolution {
  JointAngles joints;
  bool reachable = false;
};

/// Pose found from drive angles. Unless `converged`, the pose is finite but means nothing.
struct ForwardSolution {
  Configuration pose;
  int iterations = 0;
  bool converged = false;
  /// Not converged, since the drives fit only a pose to which the robot would have had to jump: with an elbow
  /// on another side than the working mode says, or with another sign of det A than at the start.
  bool other_branch = false;
};

/// Largest number of entries of Kinematics::searched: eight coordinates a leg, and six of the platform.
inline constexpr int max_searched = 8 * max_dof + 6;

/// Everything about the robot's motion at one instant, evaluated once a tick and handed on by reference.
/// Jacobian J_b_a maps rates of a to rates of b; dJ_b_a is its time derivative. Source: [SafePR] (1), (2).
struct Kinematics {
  Configuration pose;       ///< x, as given.
  PlatformVector velocity;  ///< v, as given.
  JointAngles joints;
  JointRates rates;
  std::array<LegPoints, max_dof> legs;  ///< Those of the robot's legs are used.

  PlatformMatrix J_qa_x, dJ_qa_x;  ///< Active joint rates from platform velocity.
  PlatformMatrix J_qp_x, dJ_qp_x;  ///< Passive joint rates from platform velocity.
  PlatformMatrix J_qc_x, dJ_qc_x;  ///< Coupling joint rates from platform velocity.
  PlatformMatrix J_x_qa, dJ_x_qa;  ///< Platform velocity from active joint rates: left inverse of J_qa_x.

  /// All independent joint coordinates, leg by leg, and what of the platform's pose follows from x, of
  /// mechanisms that search for them: dynamics and points then need no search. Empty for others.
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_searched, 1> searched;

  /// Of the constraints by pose; 0 at a type-II singularity. Scaled as the mechanism says.
  double det_A = 0.0;
  double det_B = 0.0;  ///< Of the constraints by drives; 0 at a type-I singularity. Scaled likewise.
  /// cond_2(J_x_qa), angles counted at the mechanism's characteristic length. [SafePR] IV-F with 1 m.
  /// Infinite when singular or unreachable.
  double sigma_kappa = std::numeric_limits<double>::infinity();

  /// The legs reach the pose: angles, points and the maps from x are usable. Otherwise they are zero.
  bool reachable = false;
  /// Reachable and far enough from singularities to invert: J_x_qa is usable too. Otherwise it is zero.
  bool valid = false;
};

/// How many joints of each sort a mechanism's kinematics tells of.
struct JointCounts {
  int active = 0;
  int passive = 0;
  int coupling = 0;
};

/// Gives all of `out` its size and makes it unreachable and zero; the pose is the origin of `space`.
void set_unreachable(ConfigurationSpace space, const JointCounts& joints, Kinematics& out) noexcept;

/// Whether every number of a reachable kinematics is finite.
bool all_finite(const Kinematics& kinematics) noexcept;

/// Number of drives that a kinematics was evaluated for.
inline int drive_count(const Kinematics& kinematics) {
  return static_cast<int>(kinematics.joints.active.size());
}

}  // namespace flinch
