#include "systems/contact/particle_locator.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

struct Block {
  explicit Block(std::uint64_t seed = 1, const LinkParticleSettings& settings = {},
                 const WrenchUncertainty& uncertainty = {})
      : block(builder.add<ParticleLocator>("locator", robot, settings, ContactLocatorSettings(), uncertainty,
                                           seed)),
        closed_form(builder.add<ContactLocator>("closed_form", robot, ContactLocatorSettings(), uncertainty)),
        phase(builder.export_input("phase", block.phase)),
        classification(builder.export_input("classification", block.classification)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        wrench(builder.export_input("wrench", block.wrench)),
        change(builder.export_input("change", block.change)),
        ticking(with_closed_form(builder)) {
    ticking.set(kinematics, k);
    ticking.set(change, test::estimate_of(k, PlatformVector::Zero(robot->dof())));
  }

  const ContactLocation& see(int number, const PlatformVector& seen) {
    if (number >= 0 && !active_) since_ = ticking.now();
    active_ = number >= 0;
    ContactClassification said;
    said.valid = active_;
    said.most_likely = number;
    ticking.set(phase, ContactPhase{active_, since_});
    ticking.set(classification, said);
    ticking.set(wrench, test::estimate_of(k, seen));
    ticking.tick();
    return ticking.get(block.location);
  }
  PlatformVector push(int leg, double fraction) const {
    return test::wrench_on_link(*robot, k, BodyId::link2(leg), fraction, {0.0, 50.0});
  }

  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
  Kinematics k = test::at_home(*robot);
  DiagramBuilder builder;
  ParticleLocator& block;
  ContactLocator& closed_form;  ///< sees the same
  InputPort<ContactPhase> phase;
  InputPort<ContactClassification> classification;
  InputPort<Kinematics> kinematics;
  InputPort<WrenchEstimate> wrench, change;
  test::Ticking ticking;

 private:
  DiagramBuilder& with_closed_form(DiagramBuilder& of) {
    of.connect(phase, closed_form.phase);
    of.connect(classification, closed_form.classification);
    of.connect(kinematics, closed_form.kinematics);
    of.connect(wrench, closed_form.wrench);
    of.connect(change, closed_form.change);
    return of;
  }

  bool active_ = false;
  Time since_{};
};

constexpr int link2_of_leg2 = ContactClasses::collision(BodyId::link2(1));

TEST(ParticleLocator, FindsThePushOnTheClassifiedSecondLink) {
  Block locator(1, {.leaning = 0.0});
  const test::AllocationCounter allocations;
  ContactLocation found;
  for (int i = 0; i < 50; ++i) found = locator.see(link2_of_leg2, locator.push(1, 0.7));
  EXPECT_EQ(allocations.count(), 0);
  ASSERT_TRUE(found.valid && found.located);
  EXPECT_EQ(found.body, link2_of_leg2);
  EXPECT_NEAR(found.fraction, 0.7, 0.04);
  EXPECT_NEAR(found.force_in_base.norm(), 50.0, 4.0);
  const ParticleCloud& cloud = locator.ticking.get(locator.block.cloud);
  EXPECT_EQ(cloud.count, 50);
  EXPECT_NEAR(cloud.fraction.head(50).mean(), found.fraction, 0.05);
}

TEST(ParticleLocator, BeginsAnewWithAnotherLinkAndWithAnotherContact) {
  Block locator;
  for (int i = 0; i < 20; ++i) locator.see(link2_of_leg2, locator.push(1, 0.8));
  EXPECT_NEAR(locator.see(ContactClasses::collision(BodyId::link2(2)), locator.push(2, 0.4)).fraction, 0.4,
              0.1);
  EXPECT_FALSE(locator.see(-1, locator.push(2, 0.4)).valid);
  EXPECT_EQ(locator.ticking.get(locator.block.cloud).count, 0);
  EXPECT_NEAR(locator.see(link2_of_leg2, locator.push(1, 0.9)).fraction, 0.9, 0.1);
}

TEST(ParticleLocator, SaysNothingOfFirstLinksAndClamping) {
  Block locator;
  for (const int number : {1, 7, 99, -1}) EXPECT_FALSE(locator.see(number, locator.push(0, 0.5)).valid);
}

constexpr int platform = ContactClasses::collision(BodyId::platform());

TEST(ParticleLocator, PlacesAPushOnThePlatformWhereTheClosedFormDoes) {
  Block locator;
  RandomGenerator random(2);
  int located = 0;
  for (const Kinematics& k : test::random_kinematics(*locator.robot, 200)) {
    const PlatformVector wrench{{40.0 * random.normal(), 40.0 * random.normal(), 4.0 * random.normal()}};
    locator.k = k;
    locator.ticking.set(locator.kinematics, k);
    locator.ticking.set(locator.change, test::estimate_of(k, 0.2 * wrench));
    const test::AllocationCounter allocations;
    const ContactLocation found = locator.see(platform, wrench);
    EXPECT_EQ(allocations.count(), 0);
    const ContactLocation& expected = locator.ticking.get(locator.closed_form.location);
    ASSERT_TRUE(found.valid && expected.valid);
    located += found.located;
    EXPECT_EQ(found.acquired, expected.acquired);
    EXPECT_EQ(found.located, expected.located);
    EXPECT_EQ(found.body, expected.body);
    EXPECT_EQ(found.point_in_base, expected.point_in_base);
    EXPECT_EQ(found.force_in_base, expected.force_in_base);
    EXPECT_EQ(found.point_deviation, expected.point_deviation);
    EXPECT_EQ(found.force_deviation, expected.force_deviation);
    EXPECT_EQ(found.residual, expected.residual);
    EXPECT_EQ(locator.ticking.get(locator.block.cloud).count, 0);
  }
  EXPECT_GT(located, 50);
  EXPECT_LT(located, 200);
}

TEST(ParticleLocator, LeavesOfTheWrenchWhatItsContactDoesNotMake) {
  const WrenchUncertainty uncertainty;
  Block locator(1, {}, uncertainty);
  RandomGenerator random(9);
  double largest = 0.0;
  for (const Kinematics& k : test::random_kinematics(*locator.robot, 100)) {
    locator.k = k;
    locator.ticking.set(locator.kinematics, k);
    const BodyId link = BodyId::link2(static_cast<int>(random() % 3));
    const PlatformVector wrench =
        test::wrench_on_link(*locator.robot, k, link, random.uniform(0.0, 1.0), {0.0, 50.0}) +
        PlatformVector{{3.0 * random.normal(), 3.0 * random.normal(), 0.3 * random.normal()}};
    locator.see(-1, wrench);
    for (int i = 0; i < 5; ++i) {
      const ContactLocation found = locator.see(link.index(), wrench);
      ASSERT_TRUE(found.valid);
      const CartesianVector in_body = locator.robot->axis_point(link, found.fraction);
      const PlatformVector missed =
          wrench - platform_wrench(locator.robot->contact_jacobian(k, link, in_body), found.force_in_base);
      const double force = wrench.head<2>().norm();
      const double of_force = std::hypot(uncertainty.force, uncertainty.share_of_force * force);
      const double of_moment = std::hypot(uncertainty.moment, uncertainty.share_of_lever * force);
      const double expected =
          std::pow(missed.head<2>().norm() / of_force, 2) + std::pow(missed[2] / of_moment, 2);
      EXPECT_NEAR(found.residual, expected, 1e-9 * (1.0 + expected));
      largest = std::max(largest, found.residual);
    }
  }
  EXPECT_GT(largest, 1.0);
}

TEST(ParticleLocator, SaysNothingOfWhatCannotBeUsed) {
  Block locator;
  const PlatformVector push = locator.push(1, 0.7), nothing = PlatformVector::Constant(3, std::nan(""));
  for (const int number : {platform, link2_of_leg2}) {
    EXPECT_TRUE(locator.see(number, push).valid);
    EXPECT_FALSE(locator.see(number, nothing).valid);
    locator.ticking.set(locator.kinematics, Kinematics());
    EXPECT_FALSE(locator.see(number, push).valid);
    locator.ticking.set(locator.kinematics, locator.k);
    locator.ticking.set(locator.change, WrenchEstimate());
    EXPECT_FALSE(locator.see(number, push).valid);
    locator.ticking.set(locator.change, test::estimate_of(locator.k, PlatformVector::Zero(3)));
    EXPECT_TRUE(locator.see(number, push).valid);
  }
  EXPECT_FALSE(locator.see(platform, PlatformVector{{0.0, 0.0, 4.0}}).valid)
      << "a moment has no line of action";
}

TEST(ParticleLocator, IsTheSameForTheSameSeed) {
  Block a(5), b(5), c(6);
  for (int i = 0; i < 10; ++i) {
    const double of_a = a.see(link2_of_leg2, a.push(1, 0.7)).fraction;
    EXPECT_EQ(of_a, b.see(link2_of_leg2, b.push(1, 0.7)).fraction);
    EXPECT_NE(of_a, c.see(link2_of_leg2, c.push(1, 0.7)).fraction);
  }
}

/// How often the covariance covers pushes anywhere on second links, in any pose, whose wrench is wrong by as
/// much as it is told, and the squared error by that covariance, of which 2 is expected.
struct Honesty {
  double covered = 0.0, squared_error = 0.0;
};

/// `slides`: while the robot moves, so that objects which move by 0.2 m/s rub against the sliding. Otherwise
/// it stands still, and pushes lean either way.
Honesty honesty_of(double leaning, int ticks, bool slides = false) {
  constexpr int pushes = 1000;
  const WrenchUncertainty uncertainty{.force = 1.5, .moment = 0.12, .share_of_force = 0, .share_of_lever = 0};
  Block locator(1, {.leaning = leaning}, uncertainty);
  RandomGenerator random(8);
  Honesty honesty;
  for (Kinematics k : test::random_kinematics(*locator.robot, pushes)) {
    if (!slides) k.velocity.setZero();
    const int leg = static_cast<int>(random() % 3);
    const double side = random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    const double fraction = random.uniform(0.0, 1.0), force = side * random.uniform(40.0, 80.0);
    double lean = leaning * random.normal();
    if (slides) {
      const LinkContactMap link = link_contact_map(*locator.robot, k, BodyId::link2(leg));
      const CartesianVector point = locator.robot->axis_point(BodyId::link2(leg), fraction) -
                                    CartesianVector(Eigen::Vector2d(0.0, side * link.radius));
      const CartesianVector moves =
          locator.robot->contact_jacobian(k, BodyId::link2(leg), point).translation * k.velocity;
      const double sliding = link.axes.col(0).dot(moves) - 0.2 * random.normal();
      lean = -std::copysign(lean, side * sliding);  // f_x / f_y
    }
    PlatformVector wrench = test::wrench_on_link(*locator.robot, k, BodyId::link2(leg), fraction,
                                                 force * Eigen::Vector2d(lean, 1.0));
    wrench += PlatformVector{{uncertainty.force * random.normal(), uncertainty.force * random.normal(),
                              uncertainty.moment * random.normal()}};
    locator.k = k;
    locator.ticking.set(locator.kinematics, k);
    locator.see(-1, wrench);
    ContactLocation found;
    for (int i = 0; i < ticks; ++i)
      found = locator.see(ContactClasses::collision(BodyId::link2(leg)), wrench);
    const CartesianVector across = link_contact_map(*locator.robot, k, BodyId::link2(leg)).axes.col(1);
    const Eigen::Vector2d error(found.fraction - fraction, found.force_in_base.dot(across) - force);
    const double square = error.dot(found.covariance.llt().solve(error));
    honesty.squared_error += square / pushes;
    honesty.covered += square < 5.991 ? 1.0 / pushes : 0.0;  // 95 % of chi-square with two degrees
  }
  std::printf("  %s pushes after %d ticks: covered %.1f %%, squared error %.2f of 2\n",
              slides          ? "sliding"
              : leaning > 0.0 ? "leaning"
                              : "orthogonal",
              ticks, 100.0 * honesty.covered, honesty.squared_error);
  return honesty;
}

TEST(ParticleLocator, CoversPushesAcrossALink) {
  for (const int ticks : {10, 50}) {
    const Honesty honesty = honesty_of(0.0, ticks);
    EXPECT_GT(honesty.covered, 0.93);
    EXPECT_LT(honesty.squared_error, 2.124);  // the 95 % band of chi-square, of 1000
  }
}

TEST(ParticleLocator, CoversPushesThatLeanForAsLongAsTheyLast) {
  for (const int ticks : {10, 50, 150}) {
    const Honesty honesty = honesty_of(0.2, ticks);
    EXPECT_GT(honesty.covered, 0.93);
    EXPECT_LT(honesty.squared_error, 3.0);  // not normal: where a force may lean bends with its place
  }
}

TEST(ParticleLocator, CoversForcesOfRoughObjectsAlongWhichLinksSlide) {
  for (const int ticks : {10, 50}) {
    const Honesty honesty = honesty_of(0.2, ticks, true);
    EXPECT_GT(honesty.covered, 0.93);
    EXPECT_LT(honesty.squared_error, 3.0);
  }
}

TEST(ParticleLocator, AsksForAsManyParticlesAsThereIsRoomFor) {
  const auto robot = test::touched_rig();
  EXPECT_THROW(ParticleLocator(robot, {.particles = 0}, {}, {}, 1), SetupError);
  EXPECT_THROW(ParticleLocator(robot, {.particles = max_particles + 1}, {}, {}, 1), SetupError);
  EXPECT_THROW(ParticleLocator(robot, {.torque_variance = 0.0}, {}, {}, 1), SetupError);
  EXPECT_THROW(ParticleLocator(robot, {}, {.least_force = 0.0}, {}, 1), SetupError);
}

}  // namespace
}  // namespace flinch
