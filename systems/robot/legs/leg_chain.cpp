#include "systems/robot/legs/leg_chain.h"

#include <cmath>

#include "systems/robot/rotation.h"

namespace flinch {

// R = R_0 Exp(q axis) = R_0 + sin q R_0 S(axis) + (1 - cos q) R_0 S(axis)^2.
void ChainJoint::set_axis(const Eigen::Matrix3d& frame, const Eigen::Vector3d& axis_in_frame) {
  const Eigen::Matrix3d S = cross_matrix(axis_in_frame.normalized());
  turn = frame;
  turn_sin = frame * S;
  turn_cos1 = frame * S * S;
  axis = frame * axis_in_frame.normalized();
}

void LegChain::place(const LegCoordinates& s, ChainPlace& out) const noexcept {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const ChainJoint& joint = joints[j];
    const auto parent = static_cast<std::size_t>(joint.parent);
    const Eigen::Matrix3d& R = joint.parent < 0 ? axes : out.axes[parent];
    const Eigen::Vector3d& p = joint.parent < 0 ? base : out.origin[parent];
    const double q = joint.position(s);
    out.axis[j].noalias() = R * joint.axis;
    out.origin[j] = p + R * joint.at;
    if (joint.slides) {
      out.origin[j] += q * out.axis[j];
      out.axes[j].noalias() = R * joint.turn;
    } else {
      const Eigen::Matrix3d turned =
          joint.turn + std::sin(q) * joint.turn_sin + (1.0 - std::cos(q)) * joint.turn_cos1;
      out.axes[j].noalias() = R * turned;
    }
  }
}

void LegChain::rates(const ChainPlace& place, const LegCoordinates& s_rate, ChainRates& out) const noexcept {
  const Eigen::Vector3d zero(0.0, 0.0, 0.0);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const ChainJoint& joint = joints[j];
    const auto parent = static_cast<std::size_t>(joint.parent);
    const bool on_base = joint.parent < 0;
    const Eigen::Vector3d& omega = on_base ? zero : out.omega[parent];
    const double rate = joint.ratio * s_rate[joint.coordinate];
    out.axis_rate[j] = omega.cross(place.axis[j]);
    out.velocity[j] =
        on_base ? zero
                : Eigen::Vector3d(out.velocity[parent] + omega.cross(place.origin[j] - place.origin[parent]));
    out.omega[j] = omega;
    (joint.slides ? out.velocity[j] : out.omega[j]) += rate * place.axis[j];
  }
}

void LegChain::columns(const ChainPlace& place, std::size_t joint, const Eigen::Vector3d& point,
                       PointColumns& out) const noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(coordinates); ++i) {
    out.v[i].setZero();
    out.w[i].setZero();
  }
  for (const std::size_t m : paths[joint]) {
    const auto i = static_cast<std::size_t>(joints[m].coordinate);
    const double ratio = joints[m].ratio;
    if (joints[m].slides) {
      out.v[i] += ratio * place.axis[m];
    } else {
      out.v[i] += ratio * place.axis[m].cross(point - place.origin[m]);
      out.w[i] += ratio * place.axis[m];
    }
  }
}

void LegChain::columns(const ChainPlace& place, const ChainRates& rates, std::size_t joint,
                       const Eigen::Vector3d& point, const Eigen::Vector3d& point_rate,
                       PointColumns& out) const noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(coordinates); ++i) {
    out.v[i].setZero();
    out.w[i].setZero();
    out.dv[i].setZero();
    out.dw[i].setZero();
  }
  for (const std::size_t m : paths[joint]) {
    const auto i = static_cast<std::size_t>(joints[m].coordinate);
    const double ratio = joints[m].ratio;
    if (joints[m].slides) {
      out.v[i] += ratio * place.axis[m];
      out.dv[i] += ratio * rates.axis_rate[m];
    } else {
      const Eigen::Vector3d arm = point - place.origin[m];
      const Eigen::Vector3d arm_rate = point_rate - rates.velocity[m];
      out.v[i] += ratio * place.axis[m].cross(arm);
      out.w[i] += ratio * place.axis[m];
      out.dv[i] += ratio * (rates.axis_rate[m].cross(arm) + place.axis[m].cross(arm_rate));
      out.dw[i] += ratio * rates.axis_rate[m];
    }
  }
}

}  // namespace flinch
