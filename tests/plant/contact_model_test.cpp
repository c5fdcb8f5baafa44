#include "plant/contact_model.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

#include "systems/robot/contact_jacobian.h"
#include "tests/plant/random_bench.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr ContactMaterial soft{};
constexpr ContactMaterial elastic{.stiffness = 6000.0, .restitution = 1.0};
constexpr ContactMaterial rubbing{.friction = 0.4};

Pylon pylon_of(const ContactMaterial& material) {
  Pylon pylon;
  pylon.material = material;
  return pylon;
}

ContactForces forces_of(const ContactModel& model, const PlanarMotion& motion,
                        const PylonMotion& pylon = {}) {
  ContactForces forces;
  model.forces(motion, pylon, ContactCandidates::all(), forces);
  return forces;
}

/// Random motions in which the pylon penetrates a body by up to 2 cm.
class PylonAgainstBodies : public testing::Test {
 protected:
  template <class Visit>
  void for_each_touch(const ContactModel& model, Visit&& visit) {
    for (int i = 0; i < 3000; ++i) {
      const PlanarMotion motion = random.motion();
      const BodyId body = BodyId::from_index(static_cast<int>(random.uniform(0.0, 7.0)));
      const PlanarCapsule capsule = model.shapes().body(motion, body);
      const double angle = random.uniform(-pi, pi);
      const double distance = capsule.radius + model.shapes().pylon_radius - random.uniform(0.0, 0.02);
      const PylonMotion pylon{capsule.begin + random.uniform(0.0, 1.0) * (capsule.end - capsule.begin) +
                                  distance * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                              random.point(0.5)};
      visit(motion, pylon, forces_of(model, motion, pylon));
    }
  }

  test::RandomBench random{21};
};

TEST_F(PylonAgainstBodies, ForceOnThePylonIsMinusThatOnTheRobot) {
  const ContactModel model(random.robot, pylon_of(rubbing), std::nullopt);
  int touched = 0;
  for_each_touch(model, [&](const PlanarMotion&, const PylonMotion&, const ContactForces& forces) {
    Eigen::Vector2d on_robot(0.0, 0.0);
    for (int i = 0; i < forces.touch_count; ++i)
      on_robot += forces.touches[static_cast<std::size_t>(i)].force_on_robot;
    EXPECT_NEAR((forces.force_on_pylon + on_robot).norm(), 0.0, 1e-12);
    touched += forces.touch_count > 0 ? 1 : 0;
  });
  EXPECT_GT(touched, 1000);
}

TEST_F(PylonAgainstBodies, PlatformWrenchIsThatOfTheContactJacobian) {
  const ContactModel model(random.robot, pylon_of(rubbing), std::nullopt);
  for_each_touch(model, [&](const PlanarMotion& motion, const PylonMotion&, const ContactForces& forces) {
    Kinematics kinematics;
    random.robot.kinematics(motion.pose, motion.velocity, kinematics);
    PlatformVector expected = PlatformVector::Zero(3);
    for (int i = 0; i < forces.touch_count; ++i) {
      const Touch& touch = forces.touches[static_cast<std::size_t>(i)];
      const PlanarCapsule axis = model.shapes().body(motion, touch.body);
      const double angle = touch.body.is_platform()
                               ? motion.pose.z()
                               : std::atan2((axis.end - axis.begin).y(), (axis.end - axis.begin).x());
      const CartesianVector in_body = Eigen::Rotation2Dd(-angle) * (touch.point - axis.begin);
      const ContactJacobian jacobian = random.robot.contact_jacobian(kinematics, touch.body, in_body);
      expected += platform_wrench(jacobian, touch.force_on_robot);
    }
    EXPECT_NEAR((forces.pylon_wrench - Eigen::Vector3d(expected)).norm(), 0.0,
                1e-9 * (1.0 + expected.norm()));
  });
}

TEST_F(PylonAgainstBodies, ForcesOnOneLegActOnThePlatformThroughItsCouplingJoint) {
  const ContactModel model(random.robot, pylon_of(rubbing), std::nullopt);
  int on_legs = 0;
  for_each_touch(model, [&](const PlanarMotion& motion, const PylonMotion&, const ContactForces& forces) {
    if (forces.touch_count != 1 || forces.touches[0].body.is_platform()) return;
    ++on_legs;
    const PlanarLeg& leg = motion.legs[static_cast<std::size_t>(forces.touches[0].body.leg())].leg;
    const Eigen::Vector2d force = forces.pylon_wrench.head<2>();
    EXPECT_NEAR(forces.pylon_wrench.z() - cross(leg.arm, force), 0.0, 1e-9 * (1.0 + force.norm()));
  });
  EXPECT_GT(on_legs, 500);
}

TEST_F(PylonAgainstBodies, RatesOfGapsAreTheirDerivatives) {
  const ContactModel model(random.robot, pylon_of(soft), std::nullopt);
  constexpr double h = 1e-6;
  for_each_touch(model, [&](const PlanarMotion& motion, const PylonMotion& pylon, const ContactForces&) {
    const auto gaps_at = [&](double t) {
      PylonGaps gaps;
      const Eigen::Vector3d pose = motion.pose + t * motion.velocity;
      model.pylon_gaps(random.robot.motion(pose, motion.velocity),
                       {pylon.position + t * pylon.velocity, pylon.velocity}, gaps);
      return gaps;
    };
    const PylonGaps now = gaps_at(0.0);
    const PylonGaps before = gaps_at(-h);
    const PylonGaps after = gaps_at(h);
    for (std::size_t body = 0; body < bench_body_count; ++body) {
      EXPECT_NEAR(now.rate[body], (after.gap[body] - before.gap[body]) / (2.0 * h), 2e-4);
    }
  });
}

TEST_F(PylonAgainstBodies, DissipationAndFrictionTakePower) {
  const ContactModel springs(random.robot, pylon_of(elastic), std::nullopt);
  const ContactModel model(random.robot, pylon_of(rubbing), std::nullopt);
  for_each_touch(model,
                 [&](const PlanarMotion& motion, const PylonMotion& pylon, const ContactForces& forces) {
                   const auto power = [&](const ContactForces& f) {
                     return f.pylon_wrench.dot(motion.velocity) + f.force_on_pylon.dot(pylon.velocity);
                   };
                   EXPECT_LE(power(forces), power(forces_of(springs, motion, pylon)) + 1e-9);
                 });
}

// ---------------------------------------------------------------- the elbow, clamping

TEST(PylonAtTheElbow, FeelsOneContactAllAroundTheOutside) {
  test::RandomBench random(22);
  const ContactModel model(random.robot, pylon_of(elastic), std::nullopt);
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
          forces_of(model, motion, {leg.passive_joint + along + distance * towards, {0.0, 0.0}});
      ASSERT_EQ(forces.touch_count, 1) << s;
      EXPECT_NEAR(forces.force_on_pylon.norm(), 6000.0 * depth, 1e-9);
      EXPECT_NEAR((forces.force_on_pylon.normalized() - towards).norm(), 0.0, 1e-9);
    }
  }
}

TEST(PylonBetweenTheLinksOfALeg, IsClampedByBoth) {
  test::RandomBench random(23);
  const ContactModel model(random.robot, pylon_of(elastic), std::nullopt);
  const PlanarMotion motion = random.robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  for (int leg = 0; leg < 3; ++leg) {
    const PlanarLeg& links = motion.legs[static_cast<std::size_t>(leg)].leg;
    const Eigen::Vector2d bisector = (links.u2 - links.u1).normalized();
    const double half_angle = 0.5 * std::acos(-links.u1.dot(links.u2));
    constexpr double depth = 2e-3;
    const double from_elbow = (0.07 - depth) / std::sin(half_angle);
    const ContactForces forces =
        forces_of(model, motion, {links.passive_joint + from_elbow * bisector, {0.0, 0.0}});
    ASSERT_EQ(forces.touch_count, 2);
    EXPECT_EQ(forces.touches[0].body, BodyId::link1(leg));
    EXPECT_EQ(forces.touches[1].body, BodyId::link2(leg));
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(forces.touches[static_cast<std::size_t>(i)].depth, depth, 1e-12);
      EXPECT_NEAR(forces.touches[static_cast<std::size_t>(i)].force_on_robot.norm(), 6000.0 * depth, 1e-9);
    }
    const Eigen::Vector2d expected = 2.0 * 6000.0 * depth * std::sin(half_angle) * bisector;
    EXPECT_NEAR((forces.force_on_pylon - expected).norm(), 0.0, 1e-9) << "both push it out of the wedge";
  }
}

TEST(PylonAtTheCouplingJoint, MeetsTheEndOfTheLinkWhereThePlatformDoesNotCoverIt) {
  PlanarRrrParameters parameters = bench_robot(BenchGeometry::individual, BenchFriction::none);
  for (const double hull_radius : {0.137, 0.05}) {
    parameters.platform_hull_radius = hull_radius;
    const PlanarRrr robot(parameters);
    const ContactModel model(robot, pylon_of(elastic), std::nullopt);
    const PlanarMotion motion = robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
    const PlanarLeg& leg = motion.legs[0].leg;
    const Eigen::Vector2d side =
        leg.arm.dot(normal(leg.u2)) > 0.0 ? normal(leg.u2) : Eigen::Vector2d(-normal(leg.u2));
    const Eigen::Vector2d beyond_the_end = (side + 0.1 * leg.u2).normalized();
    const Eigen::Vector2d pylon = leg.coupling_joint + (0.03 + 0.04 - 1e-3) * beyond_the_end;
    const ContactForces forces = forces_of(model, motion, {pylon, {0.0, 0.0}});
    ASSERT_EQ(forces.touch_count, 1) << hull_radius;
    if (hull_radius == 0.137) {
      EXPECT_EQ(forces.touches[0].body, BodyId::platform());
    } else {
      EXPECT_EQ(forces.touches[0].body, BodyId::link2(0));
      EXPECT_NEAR((forces.force_on_pylon - 6.0 * beyond_the_end).norm(), 0.0, 1e-9);
    }
  }
}

// ---------------------------------------------------------------- energy

/// Sum of the springs' energies over all pairs.
double potential(const ContactModel& model, const PlanarMotion& motion, const PylonMotion& pylon,
                 double stiffness) {
  double energy = 0.0;
  for (const ContactPair& pair : contact_pairs) {
    for_each_gap(model.shapes(), pair, motion, model.shapes().round(pair, motion, pylon),
                 [&](BodyId, const DiscGap& gap) {
                   if (gap.gap < 0.0) energy += 0.5 * stiffness * gap.gap * gap.gap;
                 });
  }
  return energy;
}

TEST(ElasticContacts, AreTheGradientOfTheirEnergy) {
  test::RandomBench random(24);
  Pylon thick = pylon_of(elastic);
  thick.radius = 0.15;
  const ContactModel model(random.robot, thick, elastic);
  constexpr double h = 1e-6;
  int of_links = 0;
  for (int i = 0; i < 20000 && of_links < 200; ++i) {
    const Eigen::Vector3d pose = random.pose();
    const PylonMotion pylon{random.point(0.5), {0.0, 0.0}};
    const ContactForces forces = forces_of(model, random.robot.motion(pose, Eigen::Vector3d::Zero()), pylon);
    if (forces.self_contact) ++of_links;
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy_at = [&](double step) {
        const Eigen::Vector3d moved = pose + step * Eigen::Vector3d::Unit(axis);
        return potential(model, random.robot.motion(moved, Eigen::Vector3d::Zero()), pylon,
                         elastic.stiffness);
      };
      const double expected = -(energy_at(h) - energy_at(-h)) / (2.0 * h);
      const double wrench = forces.pylon_wrench[axis] + forces.self_wrench[axis];
      ASSERT_NEAR(wrench, expected, 2e-5 * (100.0 + std::abs(expected)));
    }
  }
  EXPECT_GE(of_links, 200) << "links met";
}

// ---------------------------------------------------------------- which pairs can touch

TEST(ContactCandidatesOfATick, MissNoContactWithinIt) {
  test::RandomBench random(25);
  const ContactModel model(random.robot, pylon_of(soft), soft);
  int touching = 0;
  int candidates_in_all = 0;
  constexpr int trials = 3000;
  for (int i = 0; i < trials; ++i) {
    const PlanarMotion start = random.motion();
    const PylonMotion pylon{random.point(0.6), random.point(1.0)};
    const ContactCandidates candidates = model.candidates(start, pylon, 1e-3);
    candidates_in_all += candidates.count();
    for (const double t : {0.0, 2.5e-4, 5e-4, 7.5e-4, 1e-3}) {
      const Eigen::Vector3d pose = start.pose + t * start.velocity;
      const PlanarMotion later = random.robot.motion(pose, start.velocity);
      if (!later.reachable) continue;
      const PylonMotion pylon_later{pylon.position + t * pylon.velocity, pylon.velocity};
      for (std::size_t pair = 0; pair < contact_pair_count; ++pair) {
        const Disc disc = model.shapes().round(contact_pairs[pair], later, pylon_later);
        for_each_gap(model.shapes(), contact_pairs[pair], later, disc, [&](BodyId, const DiscGap& gap) {
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

TEST(ContactModel, WithoutAPylonOrLinkMaterialNothingTouches) {
  test::RandomBench random(26);
  const ContactModel model(random.robot, std::nullopt, std::nullopt);
  const PlanarMotion motion = random.robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  EXPECT_EQ(model.candidates(motion, {}, 1e-3), ContactCandidates());
  const ContactForces forces = forces_of(model, motion);
  EXPECT_EQ(forces.touch_count, 0);
  EXPECT_EQ(forces.pylon_wrench, Eigen::Vector3d::Zero());
  PylonGaps gaps;
  model.pylon_gaps(motion, {}, gaps);
  EXPECT_EQ(gaps.gap[0], HUGE_VAL);
}

TEST(ContactModel, DoesNotAllocate) {
  test::RandomBench random(27);
  const ContactModel model(random.robot, pylon_of(soft), soft);
  const PlanarMotion motion = random.motion();
  const PylonMotion pylon{motion.pose.head<2>(), {0.0, 0.0}};
  PylonGaps gaps;
  const test::AllocationCounter counter;
  const ContactForces forces = forces_of(model, motion, pylon);
  const ContactCandidates candidates = model.candidates(motion, pylon, 1e-3);
  model.pylon_gaps(motion, pylon, gaps);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(forces.touch_count, 0);
  EXPECT_GT(candidates.count(), 0);
}

}  // namespace
}  // namespace flinch
