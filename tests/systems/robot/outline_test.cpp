#include "systems/robot/outline.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace flinch {
namespace {

using Inside = std::function<bool(const Eigen::Vector3d&)>;

class RandomLines {
 public:
  Eigen::Vector3d vector(double size) {
    return size * Eigen::Vector3d(normal_(engine_), normal_(engine_), normal_(engine_));
  }

 private:
  std::mt19937 engine_{3};
  std::normal_distribution<double> normal_;
};

/// Whether lines enter and leave `outline` where `inside`, said in another way, begins and ends to hold.
void expect_agreement(const Outline& outline, const Inside& inside, int least_hits) {
  RandomLines random;
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point = random.vector(0.2);
    const Eigen::Vector3d direction = random.vector(1.0).normalized();
    const LinePassage passage = outline.passage(point, direction);
    const auto at = [&](double s) { return inside(point + s * direction); };
    if (!passage.hits) {
      for (double s = -2.0; s < 2.0; s += 0.005) ASSERT_FALSE(at(s));
      continue;
    }
    ++hits;
    ASSERT_LE(passage.enter, passage.leave);
    const double small = 1e-7;
    EXPECT_FALSE(at(passage.enter - small));
    EXPECT_FALSE(at(passage.leave + small));
    if (passage.leave - passage.enter < 3.0 * small) continue;
    EXPECT_TRUE(at(passage.enter + small));
    EXPECT_TRUE(at(passage.leave - small));
    const Eigen::Vector3d entered = point + passage.enter * direction;
    const Eigen::Vector3d normal = outline.normal_at(entered);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
    EXPECT_LT(normal.dot(direction), 1e-3);  // a line comes in against the outward normal
    EXPECT_FALSE(inside(entered + 1e-6 * normal));
  }
  EXPECT_GT(hits, least_hits);
}

TEST(Outline, OfASphereIsWhereItsRadiusEnds) {
  const Sphere sphere{.centre = {0.05, -0.02, 0.03}, .radius = 0.15};
  expect_agreement(
      Outline({sphere}), [&](const Eigen::Vector3d& p) { return (p - sphere.centre).norm() < 0.15; }, 100);
}

TEST(Outline, OfACapsuleIsWhereTheDistanceFromItsAxisEnds) {
  const Capsule capsule{.begin = {-0.1, 0.0, 0.05}, .end = {0.2, 0.1, 0.0}, .radius = 0.05};
  const auto inside = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d axis = capsule.end - capsule.begin;
    const double t = std::clamp((p - capsule.begin).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    return (p - capsule.begin - t * axis).norm() < capsule.radius;
  };
  expect_agreement(Outline({capsule}), inside, 100);
}

Box turned_box() {
  Box box{.centre = {0.03, 0.0, -0.02}, .half_lengths = {0.1, 0.2, 0.05}};
  box.axes = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  return box;
}

TEST(Outline, OfABoxIsThatOfTheHullOfItsCorners) {
  const Box box = turned_box();
  const auto inside = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d local = box.axes.transpose() * (p - box.centre);
    return (local.array().abs() < box.half_lengths.array()).all();
  };
  expect_agreement(Outline({box}), inside, 100);
  ConvexHull hull;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? 0.1 : -0.1, (i & 2) != 0 ? 0.2 : -0.2,
                                 (i & 4) != 0 ? 0.05 : -0.05);
    hull.points.emplace_back(box.centre + box.axes * corner);
  }
  hull.points.emplace_back(box.centre);  // a point inside changes nothing
  expect_agreement(Outline({hull}), inside, 100);
}

TEST(Outline, OfADiscInThePlane) {
  const Outline disc({Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.137}});
  const LinePassage passage = disc.passage({0.0, 0.05, 0.0}, {-1.0, 0.0, 0.0});
  ASSERT_TRUE(passage.hits);
  const double half = std::sqrt(0.137 * 0.137 - 0.05 * 0.05);
  EXPECT_NEAR(passage.enter, -half, 1e-15);  // pushed from the right: the line enters at x = +half
  EXPECT_NEAR(passage.leave, half, 1e-15);
  EXPECT_FALSE(disc.passage({0.0, 0.1371, 0.0}, {-1.0, 0.0, 0.0}).hits);
  EXPECT_EQ(disc.farthest({0.0, 1.0, 0.0}), Eigen::Vector3d(0.0, 0.137, 0.0));
}

TEST(Outline, OfNothingIsNeverHit) {
  const Outline nothing({});
  EXPECT_FALSE(nothing.passage(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()).hits);
  EXPECT_EQ(nothing.farthest(Eigen::Vector3d::UnitX()), Eigen::Vector3d(Eigen::Vector3d::Zero()));
  EXPECT_EQ(nothing.normal_at(Eigen::Vector3d::UnitX()), Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace flinch
