#include "systems/robot/configuration_space.h"

#include <cmath>

#include "systems/robot/angles.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

Eigen::Vector4d quaternion(const Configuration& x) { return x.segment<4>(3); }

}  // namespace

Configuration ConfigurationSpace::origin() const noexcept {
  Configuration x = Configuration::Zero(stored());
  if (kind_ == Kind::spatial_pose) x[3] = 1.0;
  return x;
}

bool ConfigurationSpace::contains(const Configuration& x) const noexcept {
  if (x.size() != stored() || !x.allFinite()) return false;
  return kind_ != Kind::spatial_pose || std::abs(quaternion(x).norm() - 1.0) < 1e-6;
}

Configuration ConfigurationSpace::plus(const Configuration& x, const PlatformVector& xi) const noexcept {
  if (x.size() != stored() || xi.size() != dimension()) return origin();
  Configuration sum = x;
  sum.head(translations()) += xi.head(translations());
  if (kind_ == Kind::planar_pose) sum[2] = wrap_angle(x[2] + xi[2]);
  if (kind_ == Kind::spatial_pose) {
    const Eigen::Vector4d q = quaternion_product(quaternion_exp(xi.tail<3>()), quaternion(x));
    sum.tail<4>() = q.normalized();
  }
  return sum;
}

PlatformVector ConfigurationSpace::difference(const Configuration& a, const Configuration& b) const noexcept {
  PlatformVector xi = PlatformVector::Zero(dimension());
  if (a.size() != stored() || b.size() != stored()) return xi;
  xi.head(translations()) = a.head(translations()) - b.head(translations());
  if (kind_ == Kind::planar_pose) xi[2] = wrap_angle(a[2] - b[2]);
  if (kind_ == Kind::spatial_pose) {
    const Eigen::Vector4d q = quaternion(b);
    const Eigen::Vector4d back(q[0], -q[1], -q[2], -q[3]);
    xi.tail<3>() = quaternion_log(quaternion_product(quaternion(a), back));
  }
  return xi;
}

double ConfigurationSpace::rotation_angle(const Configuration& x) const noexcept {
  if (x.size() != stored() || rotations() == 0) return 0.0;
  return difference(x, origin()).tail(rotations()).norm();
}

}  // namespace flinch
