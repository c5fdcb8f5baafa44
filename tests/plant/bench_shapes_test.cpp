#include "plant/bench_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "plant/broad_phase.h"
#include "tests/plant/bullet_gap.h"
#include "tests/plant/random_bench.h"

namespace flinch {
namespace {

constexpr BenchShapes shapes{.link_radius = 0.03, .platform_radius = 0.137, .pylon_radius = 0.04};

// The least gap that a body sees in all pairs of two legs, which joints of either against links of the other
// make.
double least_gap_of_legs(const PlanarMotion& motion, int leg, int other) {
  double least = 1e9;
  for (const ContactPair& pair : contact_pairs) {
    const bool of_these =
        (pair.round_leg == leg && pair.leg == other) || (pair.round_leg == other && pair.leg == leg);
    if (!of_these) continue;
    for_each_gap(shapes, pair, motion, shapes.round(pair, motion, {}),
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

TEST(ContactPairs, AreAllDifferentAndComeWithThePylonFirst) {
  std::set<std::tuple<int, int, int, int>> seen;
  for (std::size_t i = 0; i < contact_pair_count; ++i) {
    const ContactPair& pair = contact_pairs[i];
    seen.insert({static_cast<int>(pair.round), pair.round_leg, static_cast<int>(pair.against), pair.leg});
    EXPECT_EQ(pair.round == ContactPair::Round::pylon, i < pylon_pair_count);
  }
  EXPECT_EQ(seen.size(), contact_pair_count);
  EXPECT_EQ(ContactCandidates::all().count(), static_cast<int>(contact_pair_count));
}

TEST(ContactCandidates, VisitExactlyThoseThatWereAdded) {
  ContactCandidates candidates;
  candidates.add(3);
  candidates.add(30);
  std::vector<const ContactPair*> visited;
  candidates.for_each([&](const ContactPair& pair) { visited.push_back(&pair); });
  ASSERT_EQ(visited.size(), 2U);
  EXPECT_EQ(visited[0], &contact_pairs[3]);
  EXPECT_EQ(visited[1], &contact_pairs[30]);
  EXPECT_TRUE(candidates.contains(3));
  EXPECT_FALSE(candidates.contains(4));
}

double gap_of_coupling_joints(const PlanarMotion& motion, int leg, int other) {
  const auto joint = [&](int i) { return motion.legs[static_cast<std::size_t>(i)].leg.coupling_joint; };
  return (joint(leg) - joint(other)).norm() - 2.0 * shapes.link_radius;
}

// Coupling joints are a fixed distance apart, and no pair: where they are nearest, nothing is compared.
TEST(BenchShapes, GapsOfJointsToLinksAreTheGapsOfTheLegsInBullet) {
  test::RandomBench random(11);
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

TEST(BenchShapes, GapsOfPlatformAndPylonAreThoseOfBullet) {
  test::RandomBench random(12);
  test::BulletGap bullet;
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const PlanarMotion motion = random.motion();
    const PylonMotion pylon{random.point(0.8), {0.0, 0.0}};
    const Disc post{pylon.position, shapes.pylon_radius};
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

TEST(BroadPhase, PutsEveryBodyIntoItsBox) {
  test::RandomBench random(13);
  const BroadPhase broad_phase(shapes, random.robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}));
  for (int i = 0; i < 3000; ++i) {
    const PlanarMotion motion = random.motion();
    const PylonMotion pylon{random.point(0.8), {0.0, 0.0}};
    const BroadPhase::Boxes boxes = broad_phase.boxes(motion, pylon);
    for (int body = 0; body < 7; ++body) {
      const PlanarCapsule capsule = shapes.body(motion, BodyId::from_index(body));
      const Eigen::Array2d low = capsule.begin.cwiseMin(capsule.end).array() - capsule.radius;
      const Eigen::Array2d high = capsule.begin.cwiseMax(capsule.end).array() + capsule.radius;
      const BroadPhase::Box& box = boxes[static_cast<std::size_t>(body)];
      EXPECT_TRUE((box.low.array() <= low + 1e-12).all());
      EXPECT_TRUE((box.high.array() >= high - 1e-12).all());
    }
    EXPECT_TRUE(boxes[BroadPhase::pylon].low.isApprox(pylon.position - Eigen::Vector2d::Constant(0.04)));
    EXPECT_TRUE(boxes[BroadPhase::pylon].high.isApprox(pylon.position + Eigen::Vector2d::Constant(0.04)));
  }
}

TEST(BroadPhase, BoxesOverlapWithinTheirReach) {
  const BroadPhase::Box left{{0.0, 0.0}, {1.0, 1.0}};
  const BroadPhase::Box right{{1.1, 0.5}, {2.0, 2.0}};
  EXPECT_FALSE(left.overlaps(right, 0.05));
  EXPECT_TRUE(left.overlaps(right, 0.15));
  EXPECT_FALSE(right.overlaps(left, 0.05));
  EXPECT_TRUE(right.overlaps(left, 0.15));
}

}  // namespace
}  // namespace flinch
