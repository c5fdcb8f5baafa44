#include "plant/planar_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "systems/robot/link_segments.h"
#include "tests/plant/bullet_gap.h"
#include "tests/plant/random_rig.h"

namespace flinch {
namespace {

constexpr int trials = 20000;

PlanarCapsule random_capsule(test::RandomRig& random) {
  const Eigen::Vector2d begin = random.point(1.0);
  const Eigen::Vector2d end = random.point(1.0);
  return {begin, end, random.uniform(0.01, 0.2)};
}

// Gap of two capsules whose axes do not cross: at one of the four ends.
double gap_at_ends(const PlanarCapsule& a, const PlanarCapsule& b) {
  return std::min(std::min(gap_to_disc(a, {b.begin, b.radius}).gap, gap_to_disc(a, {b.end, b.radius}).gap),
                  std::min(gap_to_disc(b, {a.begin, a.radius}).gap, gap_to_disc(b, {a.end, a.radius}).gap));
}

TEST(GapToDisc, AgreesWithBulletForAnUprightPost) {
  test::RandomRig random(1);
  test::BulletGap bullet;
  double worst = 0.0;
  for (int i = 0; i < trials; ++i) {
    const PlanarCapsule capsule = random_capsule(random);
    const Disc post{random.point(1.5), random.uniform(0.02, 0.1)};
    worst = std::max(worst, std::abs(gap_to_disc(capsule, post).gap - bullet.to_post(capsule, post)));
  }
  std::cout << "largest difference from Bullet: " << worst << " m\n";
  EXPECT_LT(worst, 1e-14);
}

TEST(GapToDisc, TakenAtTheFourEndsAgreesWithBulletForTwoCapsules) {
  test::RandomRig random(2);
  test::BulletGap bullet;
  double worst = 0.0;
  int compared = 0;
  for (int i = 0; i < trials; ++i) {
    const PlanarCapsule a = random_capsule(random);
    const PlanarCapsule b = random_capsule(random);
    const double between_axes = segment_distance({a.begin, a.end}, {b.begin, b.end}).distance;
    if (between_axes < 1e-6) continue;  // crossing axes: deeper than any contact
    ++compared;
    const double gap = gap_at_ends(a, b);
    worst = std::max(worst, std::abs(gap - bullet(a, b)));
    EXPECT_NEAR(gap, between_axes - a.radius - b.radius, 1e-14);
  }
  std::cout << "largest difference from Bullet: " << worst << " m in " << compared << " pairs\n";
  EXPECT_LT(worst, 1e-14);
  EXPECT_GT(compared, trials / 2);
}

TEST(GapToDisc, PointsFromTheAxisToTheCentre) {
  test::RandomRig random(3);
  for (int i = 0; i < trials; ++i) {
    const PlanarCapsule capsule = random_capsule(random);
    const Disc disc{random.point(1.5), 0.04};
    const DiscGap nearest = gap_to_disc(capsule, disc);
    const Eigen::Vector2d axis = capsule.end - capsule.begin;
    EXPECT_NEAR(nearest.normal.norm(), 1.0, 1e-14);
    EXPECT_TRUE(nearest.axis_point.isApprox(capsule.begin + nearest.fraction * axis, 1e-14));
    const double distance = nearest.gap + capsule.radius + disc.radius;
    EXPECT_TRUE((nearest.axis_point + distance * nearest.normal).isApprox(disc.centre, 1e-13));
    if (nearest.fraction > 0.0 && nearest.fraction < 1.0) {
      EXPECT_NEAR(distance * nearest.normal.dot(axis), 0.0, 1e-14);
    }
  }
}

TEST(GapToDisc, ServesCapsulesWithoutLengthAndCentresOnTheAxis) {
  const PlanarCapsule disc{{0.1, 0.2}, {0.1, 0.2}, 0.05};
  EXPECT_NEAR(gap_to_disc(disc, {{0.4, 0.6}, 0.1}).gap, 0.35, 1e-15);
  EXPECT_EQ(gap_to_disc(disc, {{0.1, 0.2}, 0.1}).normal.norm(), 1.0);

  const PlanarCapsule capsule{{0.0, 0.0}, {2.0, 0.0}, 0.1};
  const DiscGap on_axis = gap_to_disc(capsule, {{0.5, 0.0}, 0.2});
  EXPECT_NEAR(on_axis.gap, -0.3, 1e-15);
  EXPECT_EQ(on_axis.fraction, 0.25);
  EXPECT_EQ(on_axis.normal, Eigen::Vector2d(0.0, 1.0));
}

}  // namespace
}  // namespace flinch
