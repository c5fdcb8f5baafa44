#include "systems/robot/convex_hull.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/framework/random.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

ConvexHull box(const Eigen::Vector3d& half_lengths, const Eigen::Vector3d& rotation = {0.0, 0.0, 0.0}) {
  ConvexHull hull;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0,
                                (i & 4) != 0 ? 1.0 : -1.0);
    hull.points.emplace_back(rotation_matrix(quaternion_exp(rotation)) * signs.cwiseProduct(half_lengths));
  }
  return hull;
}

TEST(Hull, IsAsThickAsTheBoxThatItIs) {
  RandomGenerator random(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d half(random.uniform(1e-5, 0.05), random.uniform(0.06, 0.2),
                               random.uniform(0.06, 0.2));
    const Eigen::Vector3d rotation(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0), 0.3);
    ConvexHull hull = box(half, rotation);
    for (Eigen::Vector3d& point : hull.points) point += Eigen::Vector3d(3.0, -2.0, 1.0);
    EXPECT_NEAR(thickness(hull), 2.0 * half.x(), 1e-14);
    EXPECT_EQ(complaint_about_points(hull).empty(), 2.0 * half.x() >= least_hull_thickness);
  }
}

TEST(Hull, OfPointsInAPlaneOrOnALineHasNoThickness) {
  RandomGenerator random(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d a(1.0, random.uniform(-1.0, 1.0), 0.2), b(random.uniform(-1.0, 1.0), 1.0, -0.3);
    ConvexHull plane, line;
    for (int k = 0; k < 12; ++k) {
      plane.points.emplace_back(random.uniform(-1.0, 1.0) * a + random.uniform(-1.0, 1.0) * b);
      line.points.emplace_back(random.uniform(-1.0, 1.0) * a + b);
    }
    EXPECT_LT(thickness(plane), 1e-14);
    EXPECT_LT(thickness(line), 1e-14);
    EXPECT_THAT(complaint_about_points(plane), HasSubstr("lie in a plane"));
    EXPECT_THAT(complaint_about_points(line), HasSubstr("lie in a plane"));
  }
}

TEST(Hull, NeedsPointsThatSpanSpaceAndNotTooMany) {
  ConvexHull hull{.points = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}}};
  const ConvexHull far{.points = {{1e200, 0.0, 0.0}, {0.0, 1e200, 0.0}, {0.0, 0.0, 1e200}, {0.0, 0.0, 0.0}}};
  EXPECT_NE(complaint_about_points(far), "") << "its thickness cannot be computed";
  EXPECT_EQ(complaint_about_points({}), "has 0 entries; a hull needs at least 4");
  EXPECT_EQ(complaint_about_points(hull), "has 3 entries; a hull needs at least 4");
  hull.points.emplace_back(0.0, 0.0, 0.1);
  EXPECT_EQ(complaint_about_points(hull), "");
  hull.points.resize(most_hull_points, {0.02, 0.02, 0.02});
  EXPECT_EQ(complaint_about_points(hull), "");
  hull.points.emplace_back(0.02, 0.02, 0.02);
  EXPECT_EQ(complaint_about_points(hull),
            "has 129 entries; a hull may have at most 128, its corners are enough");
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    hull = box({0.1, 0.1, 0.1});
    hull.points[5].y() = bad;
    EXPECT_EQ(complaint_about_points(hull), "must be finite");
  }
}

}  // namespace
}  // namespace flinch
