#pragma once

#include <Eigen/Dense>
#include <array>

namespace flinch::sample {

/// Geometry of the planar 3-RRR rig, enough to draw and to map forces to torques.
struct Leg {
  double angle;     ///< psi [rad]
  double base;      ///< Radius of the base joint [m].
  double proximal;  ///< [m]
  double distal;    ///< [m]
  double coupling;  ///< beta: direction of the coupling joint on the platform [rad].

  Eigen::Vector2d base_joint() const;
  Eigen::Vector2d coupling_in_platform() const;
};

inline constexpr double degree = 0.017453292519943295;
inline constexpr std::array<Leg, 3> legs{{
    {90.0 * degree, 0.6877, 0.58152, 0.62002, 0.0},
    {210.7631 * degree, 0.6922, 0.58121, 0.61964, 120.0 * degree},
    {330.4901 * degree, 0.6666, 0.58215, 0.61975, 240.0 * degree},
}};

/// What the page needs of one pose (x, y, phi).
struct Configuration {
  Eigen::Vector3d qa;                       ///< Drive angles [rad].
  Eigen::Matrix3d J_x_qa;                   ///< Platform velocity from drive rates.
  std::array<Eigen::Vector2d, 3> elbow;     ///< [m]
  std::array<Eigen::Vector2d, 3> coupling;  ///< [m]
};

Configuration configuration(const Eigen::Vector3d& pose);

/// Condition number of J_x_qa.
double sigma_kappa(const Configuration& configuration);

/// Smallest distance of link axes of different legs, sampled along the links [m].
double sigma_sc(const Configuration& configuration);

}  // namespace flinch::sample
