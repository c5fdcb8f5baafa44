#include "plant/planar_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "plant/contact_candidates.h"
#include "tests/plant/bullet_gap.h"
#include "tests/plant/random_rig.h"

namespace flinch {
namespace {

constexpr PlanarShapes shapes{.link_radius = 0.03, .platform_radius = 0.137};
constexpr double post_radius = 0.04;

// The least gap that a body sees in all pairs of two legs, which joints of either against links of the other
// make.
double least_gap_of_legs(const PlanarMotion& motion, int leg, int other) {
  double least = 1e9;
  for (std::size_t i = 0; i < planar_self_pairs; ++i) {
    const PlanarPair pair = planar_pair(i);
    const bool of_these =
        (pair.which == leg && pair.leg == other) || (pair.which == other && pair.leg == leg);
    if (!of_these) continue;
    for_each_gap(shapes, pair, motion, shapes.joint(pair, motion),
                 [&](BodyId, const DiscGap& gap) { least = std::min(least, gap.gap); });
  }
  return least;
}

double least_bullet_gap_of_legs(test::BulletGap& bullet, const PlanarMotion& motion, int leg, int other) {
  double least = 1e9;
  for (const BodyId a : {BodyId::link1(leg), BodyId::link2(leg)}) {
    for (const BodyId b : {BodyId::link1(other), BodyId::link2(other)}) {
      least = std::min(least, bullet(shapes.body(motion, a), shapes.body(motion, b)));
    }
  }
  return least;
}

TEST(PlanarPairs, AreAllDifferentAndComeWithTheRobotsOwnFirst) {
  std::set<std::tuple<int, int, int, int>> seen;
  const std::size_t count = planar_self_pairs + 3 * planar_pairs_of_obstacle;
  for (std::size_t i = 0; i < count; ++i) {
    const PlanarPair pair = planar_pair(i);
    seen.insert({static_cast<int>(pair.round), pair.which, static_cast<int>(pair.against), pair.leg});
    EXPECT_EQ(pair.round == PlanarPair::Round::obstacle, i >= planar_self_pairs);
  }
  EXPECT_EQ(seen.size(), count);
}

TEST(ContactCandidates, VisitExactlyThoseThatWereAdded) {
  ContactCandidates candidates;
  for (const std::size_t pair : {3U, 63U, 64U, 200U}) candidates.add(pair);
  std::vector<std::size_t> visited;
  candidates.for_each(200, [&](std::size_t pair) { visited.push_back(pair); });
  EXPECT_EQ(visited, (std::vector<std::size_t>{3, 63, 64})) << "those below the end";
  EXPECT_TRUE(candidates.contains(200));
  EXPECT_FALSE(candidates.contains(4));
  EXPECT_EQ(candidates.count(), 4);
  EXPECT_EQ(ContactCandidates::all().count(), static_cast<int>(ContactCandidates::capacity));
}

double gap_of_coupling_joints(const PlanarMotion& motion, int leg, int other) {
  const auto joint = [&](int i) { return motion.legs[static_cast<std::size_t>(i)].leg.coupling_joint; };
  return (joint(leg) - joint(other)).norm() - 2.0 * shapes.link_radius;
}

// Coupling joints are a fixed distance apart, and no pair: where they are nearest, nothing is compared.
TEST(PlanarShapes, GapsOfJointsToLinksAreTheGapsOfTheLegsInBullet) {
  test::RandomRig random(11);
  test::BulletGap bullet;
  double worst = 0.0;
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const PlanarMotion motion = random.motion();
    for (const auto& [leg, other] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)}) {
      const double expected = least_bullet_gap_of_legs(bullet, motion, leg, other);
      if (expected < -2.0 * shapes.link_radius + 1e-6) continue;  // axes cross
      if (expected > gap_of_coupling_joints(motion, leg, other) - 1e-12) continue;
      ++compared;
      worst = std::max(worst, std::abs(least_gap_of_legs(motion, leg, other) - expected));
    }
  }
  std::cout << "largest difference from Bullet: " << worst << " m in " << compared << " pairs of legs\n";
  EXPECT_GT(compared, 3000);
  EXPECT_LT(worst, 1e-14);
}

TEST(PlanarShapes, GapsOfPlatformAndPylonAreThoseOfBullet) {
  test::RandomRig random(12);
  test::BulletGap bullet;
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const PlanarMotion motion = random.motion();
    const Disc post{random.point(0.8), post_radius};
    for (int body = 0; body < 7; ++body) {
      const PlanarCapsule capsule = shapes.body(motion, BodyId::from_index(body));
      worst = std::max(worst, std::abs(gap_to_disc(capsule, post).gap - bullet.to_post(capsule, post)));
    }
    const PlanarCapsule platform = shapes.body(motion, BodyId::platform());
    for (int leg = 0; leg < 3; ++leg) {
      const PlanarCapsule link = shapes.body(motion, BodyId::link1(leg));
      const double gap = gap_to_disc(link, {platform.begin, platform.radius}).gap;
      worst = std::max(worst, std::abs(gap - bullet(link, platform)));
    }
  }
  std::cout << "largest difference from Bullet: " << worst << " m\n";
  EXPECT_LT(worst, 1e-14);
}

}  // namespace
}  // namespace flinch
