#pragma once

#include <Eigen/Core>

#include "systems/robot/rotation.h"

/// The equations of motion of any mechanism, as a sum over its rigid bodies in space. Base frame; v has n
/// entries. [SafePR] (4)
namespace flinch {

/// Inertia of a rigid body.
struct RigidBodyInertia {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d centre_of_mass{0.0, 0.0, 0.0};      ///< In the body's frame [m].
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< About it, in the body's axes [kg m^2].
};

/// A body of the same shape that is `factor` times as heavy.
RigidBodyInertia scaled(const RigidBodyInertia& body, double factor);

/// Inertia about the origin of the body's frame, in the body's axes [kg m^2].
Eigen::Matrix3d about_origin(const RigidBodyInertia& body);

/// Inertia of two bodies that are fixed to one another, both given in one frame.
RigidBodyInertia together(const RigidBodyInertia& a, const RigidBodyInertia& b);

/// Maps from v to the velocity of a point [m/s] and of its body [rad/s], and their time derivatives.
template <int n>
struct PointMotion {
  using Map = Eigen::Matrix<double, 3, n>;
  Map J = Map::Zero();
  Map dJ = Map::Zero();
};

/// How one body moves: its frame and the maps from v to the velocity of the frame's origin (J_o) and to the
/// angular velocity (J_w).
template <int n>
struct BodyMotion {
  using Map = Eigen::Matrix<double, 3, n>;
  using Vector = Eigen::Matrix<double, n, 1>;

  Eigen::Vector3d origin{0.0, 0.0, 0.0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< R: from the body's to the base frame.
  Map J_o = Map::Zero();
  Map J_w = Map::Zero();
  Map dJ_o = Map::Zero();
  Map dJ_w = Map::Zero();

  /// The point at `arm` from the origin, in base axes, while the body turns with `omega`:
  /// J_c = J_o - S(r) J_w, dJ_c = dJ_o - S(omega x r) J_w - S(r) dJ_w.
  PointMotion<n> point(const Eigen::Vector3d& arm, const Eigen::Vector3d& omega) const {
    const Eigen::Matrix3d S = cross_matrix(arm);
    return {J_o - S * J_w, dJ_o - cross_matrix(omega.cross(arm)) * J_w - S * dJ_w};
  }
};

/// M dv + C v + g of bodies and drives, summed one by one. dM/dt = C + C^T.
template <int n>
struct BodyDynamics {
  using Matrix = Eigen::Matrix<double, n, n>;
  using Vector = Eigen::Matrix<double, n, 1>;

  Matrix M = Matrix::Zero();
  Matrix C = Matrix::Zero();
  Vector g = Vector::Zero();

  /// M += m J_v^T J_v + J_w^T I J_w, C += m J_v^T dJ_v + J_w^T I dJ_w + J_w^T S(omega) I J_w, g -= m J_v^T
  /// gravity, J_v at the centre of mass.
  void add_body(const RigidBodyInertia& body, const BodyMotion<n>& motion, const Vector& v,
                const Eigen::Vector3d& gravity) {
    const Eigen::Vector3d omega = motion.J_w * v;
    const Eigen::Vector3d arm = motion.axes * body.centre_of_mass;
    const Eigen::Matrix3d I = motion.axes * body.inertia * motion.axes.transpose();
    const PointMotion<n> centre = motion.point(arm, omega);
    const Eigen::Matrix<double, n, 3> force = body.mass * centre.J.transpose();
    const Eigen::Matrix<double, n, 3> moment = motion.J_w.transpose() * I;
    const Eigen::Matrix<double, n, 3> gyroscopic = motion.J_w.transpose() * (cross_matrix(omega) * I);
    M.noalias() += force * centre.J + moment * motion.J_w;
    C.noalias() += force * centre.dJ + moment * motion.dJ_w + gyroscopic * motion.J_w;
    g.noalias() -= force * gravity;
  }

  /// A drive's rotor or screw, `armature` [kg m^2 or kg], that moves with `row` v.
  void add_armature(double armature, const Eigen::Matrix<double, 1, n>& row,
                    const Eigen::Matrix<double, 1, n>& row_rate) {
    M.noalias() += armature * row.transpose() * row;
    C.noalias() += armature * row.transpose() * row_rate;
  }
};

}  // namespace flinch
