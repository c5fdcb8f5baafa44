#include "plant/planar_rig.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "plant/rig_of.h"
#include "systems/robot/contact_jacobian.h"
#include "tests/plant/random_rig.h"
#include "tests/plant/rig_scene.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

constexpr double pi = 3.14159265358979323846;
const ContactMaterial soft{};
const ContactMaterial elastic{.stiffness = 6000.0, .restitution = 1.0};
const ContactMaterial rubbing{.friction = 0.4};

/// Where the post is in a test.
struct PostMotion {
  Eigen::Vector2d position{0.0, 0.0};
  Eigen::Vector2d velocity{0.0, 0.0};
};

/// The planar rig with one round post that a test puts where it likes.
class Scene {
 public:
  Scene(const std::shared_ptr<const PlanarRrr>& robot, const ContactMaterial& post,
        const std::optional<ContactMaterial>& links, double radius = 0.04)
      : settings_(settings(robot, post, links, radius)), rig(settings_) {}

  const PlanarRig& planar() const { return rig.moving_robot(); }
  const PlanarShapes& shapes() const { return planar().shapes(); }
  static PlacedObstacles placed(const PostMotion& post) {
    PlacedObstacles obstacles;
    obstacles[0] = {{post.position.x(), post.position.y(), 0.0}, {post.velocity.x(), post.velocity.y(), 0.0}};
    return obstacles;
  }

  ContactForces forces(const PlanarMotion& motion, const PostMotion& post = {}) const {
    ContactForces found(3);
    rig.find_forces(motion, placed(post), {}, ContactCandidates::all(), found);
    return found;
  }

 private:
  static RigSettings settings(const std::shared_ptr<const PlanarRrr>& robot, const ContactMaterial& post,
                              const std::optional<ContactMaterial>& links, double radius) {
    ObstacleForm form = test::post_form(0.0, 0.0, post);
    form.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = radius};
    RigSettings settings;
    settings.robot = robot;
    settings.obstacles = {std::make_shared<const FixedObstacle>(form)};
    settings.link_material = links;
    return settings;
  }

  RigSettings settings_;

 public:
  RigOf<PlanarRig> rig;
};

/// Random motions in which the post penetrates a body by up to 2 cm.
class PylonAgainstBodies : public testing::Test {
 protected:
  template <class Visit>
  void for_each_touch(const Scene& model, Visit&& visit) {
    for (int i = 0; i < 3000; ++i) {
      const PlanarMotion motion = random.motion();
      const BodyId body = BodyId::from_index(static_cast<int>(random.uniform(0.0, 7.0)));
      const PlanarCapsule capsule = model.shapes().body(motion, body);
      const double angle = random.uniform(-pi, pi);
      const double distance = capsule.radius + 0.04 - random.uniform(0.0, 0.02);
      const PostMotion pylon{capsule.begin + random.uniform(0.0, 1.0) * (capsule.end - capsule.begin) +
                                 distance * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                             random.point(0.5)};
      visit(motion, pylon, model.forces(motion, pylon));
    }
  }

  test::RandomRig random{21};
};

TEST_F(PylonAgainstBodies, ForceOnThePylonIsMinusThatOnTheRobot) {
  const Scene model(random.shared, rubbing, std::nullopt);
  int touched = 0;
  for_each_touch(model, [&](const PlanarMotion&, const PostMotion&, const ContactForces& forces) {
    Eigen::Vector3d on_robot(0.0, 0.0, 0.0);
    for (int i = 0; i < forces.touch_count; ++i)
      on_robot += forces.touches[static_cast<std::size_t>(i)].force_on_robot;
    EXPECT_NEAR((forces.on_obstacle[0] + on_robot).norm(), 0.0, 1e-12);
    touched += forces.touch_count > 0 ? 1 : 0;
  });
  EXPECT_GT(touched, 1000);
}

TEST_F(PylonAgainstBodies, PlatformWrenchIsThatOfTheContactJacobian) {
  const Scene model(random.shared, rubbing, std::nullopt);
  for_each_touch(model, [&](const PlanarMotion& motion, const PostMotion&, const ContactForces& forces) {
    Kinematics kinematics;
    random.robot.kinematics(motion.pose, motion.velocity, kinematics);
    PlatformVector expected = PlatformVector::Zero(3);
    for (int i = 0; i < forces.touch_count; ++i) {
      const Touch& touch = forces.touches[static_cast<std::size_t>(i)];
      const PlanarCapsule axis = model.shapes().body(motion, BodyId::from_index(touch.body));
      const double angle = touch.body == 0
                               ? motion.pose.z()
                               : std::atan2((axis.end - axis.begin).y(), (axis.end - axis.begin).x());
      const CartesianVector in_body = Eigen::Rotation2Dd(-angle) * (touch.point.head<2>() - axis.begin);
      const ContactJacobian jacobian =
          random.robot.contact_jacobian(kinematics, BodyId::from_index(touch.body), in_body);
      expected += platform_wrench(jacobian, touch.force_on_robot.head<2>());
    }
    EXPECT_NEAR((forces.obstacle_wrench - expected).norm(), 0.0, 1e-9 * (1.0 + expected.norm()));
  });
}

TEST_F(PylonAgainstBodies, ForcesOnOneLegActOnThePlatformThroughItsCouplingJoint) {
  const Scene model(random.shared, rubbing, std::nullopt);
  int on_legs = 0;
  for_each_touch(model, [&](const PlanarMotion& motion, const PostMotion&, const ContactForces& forces) {
    if (forces.touch_count != 1 || forces.touches[0].body == 0) return;
    ++on_legs;
    const PlanarLeg& leg =
        motion.legs[static_cast<std::size_t>(BodyId::from_index(forces.touches[0].body).leg())].leg;
    const Eigen::Vector2d force = forces.obstacle_wrench.head(2);
    EXPECT_NEAR(forces.obstacle_wrench[2] - cross(leg.arm, force), 0.0, 1e-9 * (1.0 + force.norm()));
  });
  EXPECT_GT(on_legs, 500);
}

TEST_F(PylonAgainstBodies, RatesOfGapsAreTheirDerivatives) {
  const Scene model(random.shared, soft, std::nullopt);
  constexpr double h = 1e-6;
  int compared = 0;
  for_each_touch(model, [&](const PlanarMotion& motion, const PostMotion& pylon, const ContactForces&) {
    const auto pairs_at = [&](double t) {
      NearPairs near;
      const Eigen::Vector3d pose = motion.pose + t * motion.velocity;
      model.planar().find_near_pairs(random.robot.motion(pose, motion.velocity),
                                     Scene::placed({pylon.position + t * pylon.velocity, pylon.velocity}),
                                     near);
      return near;
    };
    const NearPairs now = pairs_at(0.0);
    const NearPairs before = pairs_at(-h);
    const NearPairs after = pairs_at(h);
    for (int i = 0; i < now.count; ++i) {
      const NearPair& pair = now.pairs[static_cast<std::size_t>(i)];
      const NearPair* const earlier = before.find(pair.body, 0);
      const NearPair* const later = after.find(pair.body, 0);
      if (earlier == nullptr || later == nullptr) continue;
      ++compared;
      EXPECT_NEAR(pair.rate, (later->gap - earlier->gap) / (2.0 * h), 2e-4);
    }
  });
  EXPECT_GT(compared, 3000);
}

TEST_F(PylonAgainstBodies, DissipationAndFrictionTakePower) {
  const Scene springs(random.shared, elastic, std::nullopt);
  const Scene model(random.shared, rubbing, std::nullopt);
  for_each_touch(
      model, [&](const PlanarMotion& motion, const PostMotion& pylon, const ContactForces& forces) {
        const auto power = [&](const ContactForces& f) {
          return f.obstacle_wrench.dot(motion.velocity) + f.on_obstacle[0].head<2>().dot(pylon.velocity);
        };
        EXPECT_LE(power(forces), power(springs.forces(motion, pylon)) + 1e-9);
      });
}

// ---------------------------------------------------------------- the elbow, clamping

TEST(PylonAtTheElbow, FeelsOneContactAllAroundTheOutside) {
  test::RandomRig random(22);
  const Scene model(random.shared, elastic, std::nullopt);
  const PlanarMotion motion = random.robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  constexpr double depth = 1e-3;
  const double distance = 0.07 - depth;
  for (const PlanarLegMotion& leg_motion : motion.legs) {
    const PlanarLeg& leg = leg_motion.leg;
    const Eigen::Vector2d outward1 = leg.sin_qp > 0.0 ? Eigen::Vector2d(-normal(leg.u1)) : normal(leg.u1);
    const Eigen::Vector2d outward2 = leg.sin_qp > 0.0 ? Eigen::Vector2d(-normal(leg.u2)) : normal(leg.u2);
    const double turn = std::atan2(cross(outward1, outward2), outward1.dot(outward2));
    for (double s = -0.1; s <= 1.1; s += 0.001) {  // along link 1, around the elbow, along link 2
      const Eigen::Vector2d towards = Eigen::Rotation2Dd(std::clamp(s, 0.0, 1.0) * turn) * outward1;
      const Eigen::Vector2d along = std::min(s, 0.0) * leg.u1 + std::max(s - 1.0, 0.0) * leg.u2;
      const ContactForces forces =
          model.forces(motion, {leg.passive_joint + along + distance * towards, {0.0, 0.0}});
      ASSERT_EQ(forces.touch_count, 1) << s;
      EXPECT_NEAR(forces.on_obstacle[0].norm(), 6000.0 * depth, 1e-9);
      EXPECT_NEAR((forces.on_obstacle[0].head<2>().normalized() - towards).norm(), 0.0, 1e-9);
    }
  }
}

TEST(PylonBetweenTheLinksOfALeg, IsClampedByBoth) {
  test::RandomRig random(23);
  const Scene model(random.shared, elastic, std::nullopt);
  const PlanarMotion motion = random.robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  for (int leg = 0; leg < 3; ++leg) {
    const PlanarLeg& links = motion.legs[static_cast<std::size_t>(leg)].leg;
    const Eigen::Vector2d bisector = (links.u2 - links.u1).normalized();
    const double half_angle = 0.5 * std::acos(-links.u1.dot(links.u2));
    constexpr double depth = 2e-3;
    const double from_elbow = (0.07 - depth) / std::sin(half_angle);
    const ContactForces forces =
        model.forces(motion, {links.passive_joint + from_elbow * bisector, {0.0, 0.0}});
    ASSERT_EQ(forces.touch_count, 2);
    EXPECT_EQ(forces.touches[0].body, BodyId::link1(leg).index());
    EXPECT_EQ(forces.touches[1].body, BodyId::link2(leg).index());
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(forces.touches[static_cast<std::size_t>(i)].depth, depth, 1e-12);
      EXPECT_NEAR(forces.touches[static_cast<std::size_t>(i)].force_on_robot.norm(), 6000.0 * depth, 1e-9);
    }
    const Eigen::Vector2d expected = 2.0 * 6000.0 * depth * std::sin(half_angle) * bisector;
    EXPECT_NEAR((forces.on_obstacle[0].head<2>() - expected).norm(), 0.0, 1e-9)
        << "both push it out of the wedge";
  }
}

TEST(PylonAtTheCouplingJoint, MeetsTheEndOfTheLinkWhereThePlatformDoesNotCoverIt) {
  PlanarRrrParameters parameters = rig_robot(RigGeometry::individual, RigFriction::none);
  for (const double hull_radius : {0.137, 0.05}) {
    parameters.platform_hull_radius = hull_radius;
    const auto shared = std::make_shared<const PlanarRrr>(parameters);
    const PlanarRrr& robot = *shared;
    const Scene model(shared, elastic, std::nullopt);
    const PlanarMotion motion = robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
    const PlanarLeg& leg = motion.legs[0].leg;
    const Eigen::Vector2d side =
        leg.arm.dot(normal(leg.u2)) > 0.0 ? normal(leg.u2) : Eigen::Vector2d(-normal(leg.u2));
    const Eigen::Vector2d beyond_the_end = (side + 0.1 * leg.u2).normalized();
    const Eigen::Vector2d pylon = leg.coupling_joint + (0.03 + 0.04 - 1e-3) * beyond_the_end;
    const ContactForces forces = model.forces(motion, {pylon, {0.0, 0.0}});
    ASSERT_EQ(forces.touch_count, 1) << hull_radius;
    if (hull_radius == 0.137) {
      EXPECT_EQ(forces.touches[0].body, 0);
    } else {
      EXPECT_EQ(forces.touches[0].body, BodyId::link2(0).index());
      EXPECT_NEAR((forces.on_obstacle[0].head<2>() - 6.0 * beyond_the_end).norm(), 0.0, 1e-9);
    }
  }
}

// ---------------------------------------------------------------- energy

constexpr std::size_t pair_count = planar_self_pairs + planar_pairs_of_obstacle;

Disc disc_of(const Scene& model, const PlanarPair& pair, const PlanarMotion& motion, const PostMotion& post) {
  if (pair.round == PlanarPair::Round::obstacle) return model.planar().disc(0, Scene::placed(post)[0]);
  return model.shapes().joint(pair, motion);
}

/// Sum of the springs' energies over all pairs.
double potential(const Scene& model, const PlanarMotion& motion, const PostMotion& pylon, double stiffness) {
  double energy = 0.0;
  const auto add = [&](BodyId, const DiscGap& gap) {
    if (gap.gap < 0.0) energy += 0.5 * stiffness * gap.gap * gap.gap;
  };
  for (std::size_t i = 0; i < pair_count; ++i)
    for_each_gap(model.shapes(), planar_pair(i), motion, disc_of(model, planar_pair(i), motion, pylon), add);
  return energy;
}

TEST(ElasticContacts, AreTheGradientOfTheirEnergy) {
  test::RandomRig random(24);
  const Scene model(random.shared, elastic, elastic, 0.15);
  constexpr double h = 1e-6;
  int of_links = 0;
  for (int i = 0; i < 20000 && of_links < 200; ++i) {
    const Eigen::Vector3d pose = random.pose();
    const PostMotion pylon{random.point(0.5), {0.0, 0.0}};
    const ContactForces forces = model.forces(random.robot.motion(pose, Eigen::Vector3d::Zero()), pylon);
    if (forces.self_contact) ++of_links;
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy_at = [&](double step) {
        const Eigen::Vector3d moved = pose + step * Eigen::Vector3d::Unit(axis);
        return potential(model, random.robot.motion(moved, Eigen::Vector3d::Zero()), pylon,
                         elastic.stiffness);
      };
      const double expected = -(energy_at(h) - energy_at(-h)) / (2.0 * h);
      const double wrench = forces.obstacle_wrench[axis] + forces.self_wrench[axis];
      ASSERT_NEAR(wrench, expected, 2e-5 * (100.0 + std::abs(expected)));
    }
  }
  EXPECT_GE(of_links, 200) << "links met";
}

// ---------------------------------------------------------------- which pairs can touch

TEST(ContactCandidatesOfATick, MissNoContactWithinIt) {
  test::RandomRig random(25);
  const Scene model(random.shared, soft, soft);
  int touching = 0;
  int candidates_in_all = 0;
  constexpr int trials = 3000;
  for (int i = 0; i < trials; ++i) {
    const PlanarMotion start = random.motion();
    const PostMotion pylon{random.point(0.6), random.point(1.0)};
    const ContactCandidates candidates =
        model.planar().find_candidates(start, Scene::placed(pylon), 1e-3).candidates;
    candidates_in_all += candidates.count();
    for (const double t : {0.0, 2.5e-4, 5e-4, 7.5e-4, 1e-3}) {
      const Eigen::Vector3d pose = start.pose + t * start.velocity;
      const PlanarMotion later = random.robot.motion(pose, start.velocity);
      if (!later.reachable) continue;
      const PostMotion pylon_later{pylon.position + t * pylon.velocity, pylon.velocity};
      for (std::size_t pair = 0; pair < pair_count; ++pair) {
        const Disc disc = disc_of(model, planar_pair(pair), later, pylon_later);
        for_each_gap(model.shapes(), planar_pair(pair), later, disc, [&](BodyId, const DiscGap& gap) {
          if (gap.gap >= 0.0) return;
          ++touching;
          EXPECT_TRUE(candidates.contains(pair));
        });
      }
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_LT(candidates_in_all, 3 * trials) << "and leave most pairs out";
}

TEST(ContactCandidatesOfATick, AreThoseOfASearchWhileAClearanceLasts) {
  test::RandomRig random(29);
  const Scene model(random.shared, soft, soft);
  int spared = 0;
  for (int i = 0; i < 500; ++i) {
    const PlanarMotion start = random.motion();
    const PostMotion pylon{random.point(0.9), random.point(1.0)};
    double clearance = 0.0;
    for (int tick = 0; tick < 30; ++tick) {
      const double t = 1e-3 * tick;
      const PlanarMotion now = random.robot.motion(start.pose + t * start.velocity, start.velocity);
      if (!now.reachable) break;
      const PlacedObstacles placed = Scene::placed({pylon.position + t * pylon.velocity, pylon.velocity});
      const ContactSearch whole = model.planar().find_candidates(now, placed, 1e-3);
      const ContactSearch next = model.planar().find_candidates(now, placed, 1e-3, clearance);
      EXPECT_EQ(next.candidates, whole.candidates);
      spared += next.clearance < clearance && next.clearance > 0.0 ? 1 : 0;
      clearance = next.clearance;
    }
  }
  EXPECT_GT(spared, 1000);
}

TEST(PlanarRig, WithoutObstaclesOrLinkMaterialNothingTouches) {
  test::RandomRig random(26);
  RigSettings settings;
  settings.robot = random.shared;
  settings.link_material.reset();
  const PlanarRig rig(settings);
  const PlanarMotion motion = random.robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  EXPECT_EQ(rig.find_candidates(motion, {}, 1e-3).candidates, ContactCandidates());
  NearPairs near;
  rig.find_near_pairs(motion, {}, near);
  EXPECT_EQ(near.count, 0);
}

TEST(PlanarRig, FindsPointsOfBodiesAgain) {
  test::RandomRig random(28);
  const Scene scene(random.shared, soft, soft);
  for (int i = 0; i < 200; ++i) {
    const PlanarMotion motion = random.motion();
    const Eigen::Vector3d point(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0);
    Kinematics kinematics;
    random.robot.kinematics(motion.pose, motion.velocity, kinematics);
    for (int body = 0; body < planar_body_count; ++body) {
      const Eigen::Vector3d in_body = scene.planar().point_in_body(motion, body, point);
      EXPECT_NEAR((scene.planar().point_in_base(motion, body, in_body) - point).norm(), 0.0, 1e-14);
      const CartesianVector expected =
          random.robot.point_on_body(kinematics, BodyId::from_index(body), in_body.head(2));
      EXPECT_NEAR((expected - point.head(2)).norm(), 0.0, 1e-12);
    }
  }
}

TEST(PlanarRig, DoesNotAllocate) {
  test::RandomRig random(27);
  const Scene model(random.shared, soft, soft);
  const PlanarMotion motion = random.motion();
  const PostMotion pylon{motion.pose.head<2>(), {0.0, 0.0}};
  NearPairs near;
  const test::AllocationCounter counter;
  const ContactForces forces = model.forces(motion, pylon);
  const ContactCandidates candidates =
      model.planar().find_candidates(motion, Scene::placed(pylon), 1e-3).candidates;
  model.planar().find_near_pairs(motion, Scene::placed(pylon), near);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(forces.touch_count, 0);
  EXPECT_GT(candidates.count(), 0);
}

}  // namespace
}  // namespace flinch
