#pragma once

#include "systems/robot/mechanism.h"
#include "systems/robot/place_kinematics.h"
#include "systems/robot/task.h"

/// The measures that a reaction must keep within limits, as tasks: sigma_kappa and sigma_sc of [SafePR] IV-F.
/// Mechanisms are taken as assembled at home. Gradients are exact, from Jacobian rates at unit velocities and
/// contact Jacobians; the drift is a second difference along the motion.
namespace flinch {

/// The places a little before and after an instant along its velocity, for second differences: pose (+)
/// +- step v. At rest there is nothing before and after: step = 0.
struct NearbyPlaces {
  double step = 0.0;  ///< [s]
  PlaceKinematics before;
  PlaceKinematics after;
};

/// The places at +- 2e-4 m or rad from `kinematics` along its velocity.
void evaluate_nearby(const Mechanism& mechanism, const Kinematics& kinematics, NearbyPlaces& out) noexcept;

/// sigma = sigma_kappa = cond_2(J_x,qa). Where several singular values are the largest, or the smallest, it
/// has no gradient; J is then the mean of theirs. Not valid at a singularity.
Task condition_number_task(const Mechanism& mechanism, const Kinematics& kinematics,
                           const NearbyPlaces& nearby) noexcept;

/// ln kappa_p of a bound on sigma_kappa that is smooth wherever the smallest singular value is single:
///   kappa_p^2 = (sum lambda_i^p)^(1/p) / lambda_min,   lambda_i the other eigenvalues of J_qa,x^T J_qa,x.
/// kappa <= kappa_p <= (n - 1)^(1 / 2p) kappa. Not valid at a singularity.
Task smooth_condition_number_task(const Mechanism& mechanism, const Kinematics& kinematics,
                                  const NearbyPlaces& nearby, int p = 8) noexcept;

/// sigma = sigma_sc: smallest distance of links of different legs [m]. On its plateau, where two points fixed
/// to the platform are nearest, J and drift are zero. Where several pairs of links are equally near, J is the
/// steepest ascent: the shortest of what lies between their gradients, along which all of them move apart.
/// Zero where links cross. Not valid for a mechanism without pairs.
Task self_collision_task(const Mechanism& mechanism, const Kinematics& kinematics,
                         const NearbyPlaces& nearby) noexcept;

}  // namespace flinch
