#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/planar_leg.h"
#include "systems/robot/planar_leg_parameters.h"

namespace flinch {

/// Equations of motion of a planar robot with n platform coordinates, summed leg by leg.
template <int n>
struct PlanarDynamics {
  Eigen::Matrix<double, n, n> M = Eigen::Matrix<double, n, n>::Zero();
  Eigen::Matrix<double, n, n> C = Eigen::Matrix<double, n, n>::Zero();
  Eigen::Matrix<double, n, 1> friction = Eigen::Matrix<double, n, 1>::Zero();

  /// Adds leg `i` of a reachable kinematics by the subsystem method in the leg's coordinates (qa, qp).
  /// [ICRA23] (7), [SafePR] (4)
  void add_leg(const PlanarLegParameters& leg, double friction_velocity, const Kinematics& kinematics,
               int i) {
    using Rows = Eigen::Matrix<double, 2, n>;
    Rows J;
    Rows dJ;
    for (int j = 0; j < n; ++j) {
      J.col(j) << kinematics.J_qa_x(i, j), kinematics.J_qp_x(i, j);
      dJ.col(j) << kinematics.dJ_qa_x(i, j), kinematics.dJ_qp_x(i, j);
    }
    const double qa_rate = kinematics.rates.active[i];
    const double qp_rate = kinematics.rates.passive[i];
    const Eigen::Vector2d qp = passive_direction(leg, kinematics.legs[static_cast<std::size_t>(i)]);
    const double p1 = leg.inertia.p1 + leg.rotor_inertia;
    const double p2 = leg.inertia.p2;
    const double p3_c = leg.inertia.p3 * qp.x();
    const double p3_s = leg.inertia.p3 * qp.y();

    Eigen::Matrix2d M_leg;
    M_leg << p1 + 2.0 * p3_c, p2 + p3_c, p2 + p3_c, p2;
    Eigen::Matrix2d C_leg;
    C_leg << -p3_s * qp_rate, -p3_s * (qa_rate + qp_rate), p3_s * qa_rate, 0.0;
    const Eigen::Vector2d efforts(friction_effort(leg.active_friction, qa_rate, friction_velocity),
                                  friction_effort(leg.passive_friction, qp_rate, friction_velocity));

    M += J.transpose() * M_leg * J;
    C += J.transpose() * (M_leg * dJ + C_leg * J);
    friction += J.transpose() * efforts;
  }

  /// Hands the sums on; `out` is invalid where they are not finite.
  void write(Dynamics& out) const {
    if (!M.allFinite() || !C.allFinite() || !friction.allFinite()) return set_invalid(n, out);
    out.M_x = M;
    out.C_x = C;
    out.g_x.setZero(n);  // The plane of motion is horizontal.
    out.F_fr_x = friction;
    out.valid = true;
  }

 private:
  // cos and sin of the passive angle, from the directions of the links.
  static Eigen::Vector2d passive_direction(const PlanarLegParameters& leg, const LegPoints& points) {
    const Eigen::Vector2d link1 = (points.passive_joint - points.base_joint).head<2>();
    const Eigen::Vector2d link2 = (points.coupling_joint - points.passive_joint).head<2>();
    return Eigen::Vector2d(link1.dot(link2), cross(link1, link2)) / (leg.link1_length * leg.link2_length);
  }
};

}  // namespace flinch
