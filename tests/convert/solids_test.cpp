// Masses and moments of solids against sums over many small pieces.
#include "convert/solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace flinch {
namespace {

/// Moments about its centre of a solid of 1 kg, from pieces in a box that holds it.
Eigen::Vector3d moments_of_pieces(const std::function<bool(const Eigen::Vector3d&)>& within,
                                  const Eigen::Vector3d& half) {
  constexpr int n = 80;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const Eigen::Vector3d share = Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5) / n;
        const Eigen::Vector3d at = (2.0 * share - Eigen::Vector3d::Ones()).cwiseProduct(half);
        if (!within(at)) continue;
        ++count;
        sum += Eigen::Vector3d::Constant(at.squaredNorm()) - at.cwiseAbs2();
      }
    }
  }
  return sum / count;
}

void expect_moments(const RigidBodyInertia& body, const Eigen::Vector3d& moments) {
  EXPECT_EQ(body.mass, 1.0);
  EXPECT_TRUE(Eigen::Vector3d(body.inertia.diagonal()).isApprox(moments, 5e-3)) << body.inertia << "\n"
                                                                                << moments.transpose();
}

TEST(Solids, HaveTheMomentsOfTheirPieces) {
  const double r = 0.3, l = 1.1;
  const auto in_cylinder = [&](const Eigen::Vector3d& p) {
    return p.head<2>().norm() < r && std::abs(p.z()) < 0.5 * l;
  };
  const auto in_capsule = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d nearest(0.0, 0.0, std::clamp(p.z(), -0.5 * l, 0.5 * l));
    return (p - nearest).norm() < r;
  };
  expect_moments(solid_sphere(1.0, r),
                 moments_of_pieces([&](const auto& p) { return p.norm() < r; }, {r, r, r}));
  expect_moments(solid_cylinder(1.0, r, l), moments_of_pieces(in_cylinder, {r, r, 0.5 * l}));
  expect_moments(solid_capsule(1.0, r, l), moments_of_pieces(in_capsule, {r, r, 0.5 * l + r}));
  const Eigen::Vector3d half(0.1, 0.2, 0.4);
  expect_moments(solid_box(1.0, half), moments_of_pieces([](const auto&) { return true; }, half));
}

TEST(Solids, HaveAxesAlongAnyDirection) {
  for (const Eigen::Vector3d& along : {Eigen::Vector3d(0.0, 0.0, 2.0), Eigen::Vector3d(0.0, 0.0, -2.0),
                                       Eigen::Vector3d(0.3, -0.4, 0.1), Eigen::Vector3d(1.0, 0.0, 0.0)}) {
    const Eigen::Matrix3d axes = axes_with_z_along(along);
    EXPECT_TRUE(axes.col(2).isApprox(along.normalized(), 1e-14)) << axes;
    EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-14)) << axes;
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace flinch
