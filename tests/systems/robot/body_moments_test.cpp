#include "systems/robot/body_moments.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

RigidBodyInertia box(const Eigen::Vector3d& sides, double mass, const Eigen::Vector3d& centre) {
  RigidBodyInertia body{.mass = mass, .centre_of_mass = centre};
  const Eigen::Vector3d squares = sides.cwiseAbs2();
  body.inertia.diagonal() = mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares);
  return body;
}

TEST(BodyMoments, AreThoseOfTheBodyThatHasThem) {
  RigidBodyInertia body = box({0.3, 0.2, 0.1}, 4.0, {0.1, -0.2, 0.3});
  body.inertia(0, 1) = body.inertia(1, 0) = 1e-3;
  const RigidBodyInertia same = body_of(moments_of(body));
  EXPECT_DOUBLE_EQ(same.mass, 4.0);
  EXPECT_LT((same.centre_of_mass - body.centre_of_mass).norm(), 1e-15);
  EXPECT_LT((same.inertia - body.inertia).norm(), 1e-14);
}

// Of two bodies that are one they are the sum.
TEST(BodyMoments, AddUp) {
  const RigidBodyInertia a = box({0.3, 0.2, 0.1}, 4.0, {0.1, 0.0, 0.3});
  const RigidBodyInertia b = box({0.1, 0.4, 0.1}, 1.5, {-0.2, 0.1, 0.0});
  EXPECT_LT((moments_of(a) + moments_of(b) - moments_of(together(a, b))).norm(), 1e-14);
}

// The integral of density times (r, 1)(r, 1)^T over a box.
TEST(ThePseudoInertia, IsTheSecondMomentOfTheDensity) {
  const Eigen::Vector3d sides(0.3, 0.2, 0.1), centre(0.1, -0.2, 0.3);
  const Eigen::Matrix4d S = pseudo_inertia(moments_of(box(sides, 4.0, centre)));
  Eigen::Matrix4d expected = Eigen::Matrix4d::Zero();
  expected.topLeftCorner<3, 3>() = 4.0 * centre * centre.transpose();
  expected.topLeftCorner<3, 3>().diagonal() += 4.0 / 12.0 * sides.cwiseAbs2();
  expected.topRightCorner<3, 1>() = 4.0 * centre;
  expected.bottomLeftCorner<1, 3>() = 4.0 * centre.transpose();
  expected(3, 3) = 4.0;
  EXPECT_LT((S - expected).norm(), 1e-14);
}

TEST(ThePseudoInertia, IsPositiveDefiniteForBodiesAlone) {
  const auto least = [](const Eigen::MatrixXd& S) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues()[0];
  };
  RigidBodyInertia body = box({0.3, 0.2, 0.1}, 4.0, {0.1, -0.2, 0.3});
  EXPECT_GT(least(pseudo_inertia(moments_of(body))), 0.0);
  EXPECT_GT(least(planar_pseudo_inertia(moments_of(body))), 0.0);
  body.inertia(2, 2) = 1.01 * (body.inertia(0, 0) + body.inertia(1, 1));
  EXPECT_LT(least(pseudo_inertia(moments_of(body))), 0.0) << "more than the sum of the others";
  EXPECT_GT(least(planar_pseudo_inertia(moments_of(body))), 0.0) << "which the plane does not feel";
  body.inertia(2, 2) = -1e-6;
  EXPECT_LT(least(planar_pseudo_inertia(moments_of(body))), 0.0);
}

TEST(BodyMoments, StandInAFileAsTheKeysOfABody) {
  const std::vector<FileValue> told = body_in_file("platform", box({0.3, 0.2, 0.1}, 4.0, {0.1, -0.2, 0.3}));
  ASSERT_EQ(told.size(), 10U);
  EXPECT_EQ(told[0].name, "platform.mass_kg");
  EXPECT_EQ(told[2].name, "platform.centre_of_mass_m[1]");
  EXPECT_EQ(told[2].value, -0.2);
  EXPECT_EQ(told[6].name, "platform.inertia_kg_m2[2]");
  EXPECT_EQ(told[9].name, "platform.inertia_products_kg_m2[2]");
}

}  // namespace
}  // namespace flinch
