#include "systems/contact/contact_locator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/line_of_action.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

PlatformMatrix noise(const ParallelRobot& robot) {
  return WrenchUncertainty().covariance(robot.space(), PlatformVector::Zero(robot.dof()));
}

ContactLocation on_platform(const ParallelRobot& robot, const Kinematics& k, const PlatformVector& wrench) {
  const Outline outline(robot.body(BodyId::platform()).shapes);
  return locate_on_platform(robot, k, outline, wrench, noise(robot), noise(robot), 1.0);
}

TEST(LocateOnPlatform, FindsThePointOfAPushAnywhereAroundIt) {
  const auto robot = test::touched_rig();
  for (const Kinematics& k : test::random_kinematics(*robot, 50)) {
    for (double around = 0.0; around < 6.2; around += 0.3) {
      for (const double lean : {-0.5, 0.0, 0.5}) {
        const Eigen::Vector2d out = unit_vector(around);
        const CartesianVector point = Eigen::Vector2d(k.pose.head<2>()) + 0.137 * out;
        const CartesianVector force = -25.0 * rotate(out, unit_vector(lean));
        const Eigen::Vector2d arm = 0.137 * out;
        const PlatformVector wrench{{force[0], force[1], arm.x() * force[1] - arm.y() * force[0]}};
        const ContactLocation found = on_platform(*robot, k, wrench);
        ASSERT_TRUE(found.valid && found.located);
        EXPECT_LT((found.point_in_base - point).norm(), 1e-12);
        EXPECT_EQ(found.force_in_base, force);
      }
    }
  }
}

TEST(LocateOnPlatform, IsOffByAsMuchAsItsDeviationSays) {
  const auto robot = test::touched_rig();
  const Outline outline(robot->body(BodyId::platform()).shapes);
  const PlatformVector deviation{{1.5, 1.5, 0.1}};
  const PlatformMatrix S = deviation.cwiseAbs2().asDiagonal();
  RandomGenerator random(3);
  double squared = 0.0;
  constexpr int pushes = 2000;
  for (const Kinematics& k : test::random_kinematics(*robot, pushes)) {
    const Eigen::Vector2d arm = 0.137 * unit_vector(random.uniform(0.0, 6.2));
    const Eigen::Vector2d force = -40.0 * rotate(arm.normalized(), unit_vector(random.uniform(-0.6, 0.6)));
    PlatformVector wrench{{force.x(), force.y(), arm.x() * force.y() - arm.y() * force.x()}};
    for (int i = 0; i < 3; ++i) wrench[i] += deviation[i] * random.normal();
    const ContactLocation found = locate_on_platform(*robot, k, outline, wrench, S, S, 1.0);
    ASSERT_TRUE(found.located);
    const CartesianVector off = found.point_in_base - CartesianVector(k.pose.head<2>() + arm);
    squared += off.squaredNorm() / (found.point_deviation * found.point_deviation) / pushes;
  }
  EXPECT_NEAR(squared, 1.0, 0.1);
}

/// Lines graze the platform that are measured less than so many of their deviations within a tangent.
constexpr double grazing = 3.0;

/// The mean squared error of the place over what its deviation says, and what that would be of a place that
/// moves as far as its line.
struct GrazingErrors {
  int count = 0;
  double squared = 0.0, squared_by_line = 0.0, widest = 0.0;

  void add(const ContactLocation& found, const CartesianVector& place, double line_deviation) {
    const double off = (found.point_in_base - place).squaredNorm();
    ++count;
    squared += off / (found.point_deviation * found.point_deviation);
    squared_by_line += off / (line_deviation * line_deviation);
    widest = std::max(widest, found.point_deviation);
  }
  void print(const char* outline) const {
    std::printf(
        "  %d grazing lines, %s: squared error %.2f of 1, by the line's deviation %.1f; widest %.0f mm\n",
        count, outline, squared / count, squared_by_line / count, 1e3 * widest);
  }
};

/// Where a line through `on_line` along `direction` enters a box about the origin, face by face.
Eigen::Vector3d entry_of_box(const Eigen::Vector3d& half, const Eigen::Vector3d& on_line,
                             const Eigen::Vector3d& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) continue;
    const double face = direction[axis] > 0.0 ? -half[axis] : half[axis];
    const Eigen::Vector3d at = on_line + (face - on_line[axis]) / direction[axis] * direction;
    if (((at.cwiseAbs() - half).array() < 1e-9).all()) return at;
  }
  ADD_FAILURE() << "the line misses the box";
  return Eigen::Vector3d::Zero();
}

TEST(LocateOnPlatform, IsOffByAsMuchAsItsDeviationSaysWhereLinesGrazeACircleOrABox) {
  const auto robot = test::touched_rig();
  constexpr double radius = 0.137, size = 40.0;
  const Eigen::Vector3d half(0.1, 0.06, 0.02);
  const PlatformVector deviation{{0.5, 0.5, 0.2}};
  const PlatformMatrix S = deviation.cwiseAbs2().asDiagonal();
  for (const bool is_box : {false, true}) {
    const Outline outline({is_box ? Shape(Box{.half_lengths = half}) : Shape(Sphere{.radius = radius})});
    RandomGenerator random(4);
    GrazingErrors errors;
    for (const Kinematics& k : test::random_kinematics(*robot, 6000)) {
      const Eigen::Vector2d n = unit_vector(random.uniform(-M_PI, M_PI));
      const Eigen::Vector2d side =
          rotate(n, Eigen::Vector2d(0.0, random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0));
      const double edge = is_box ? half.head<2>().dot(side.cwiseAbs()) : radius;
      const double line_deviation = std::hypot(deviation[2], deviation[0] * edge) / size;
      const double offset = edge - random.uniform(0.0, 2.0 * grazing * line_deviation);
      const Eigen::Vector2d on_line = offset * side;
      const Eigen::Vector2d arm =
          is_box ? Eigen::Vector2d(
                       entry_of_box(half, {on_line.x(), on_line.y(), 0.0}, {n.x(), n.y(), 0.0}).head<2>())
                 : Eigen::Vector2d(on_line - std::sqrt(radius * radius - offset * offset) * n);
      const Eigen::Vector2d turn = unit_vector(k.pose[2]);
      const Eigen::Vector2d force = size * rotate(n, turn), arm_in_base = rotate(arm, turn);
      PlatformVector wrench{
          {force.x(), force.y(), arm_in_base.x() * force.y() - arm_in_base.y() * force.x()}};
      for (int i = 0; i < 3; ++i) wrench[i] += deviation[i] * random.normal();
      const double measured = std::abs(wrench[2]) / wrench.head<2>().norm();
      const ContactLocation found = locate_on_platform(*robot, k, outline, wrench, S, S, 1.0);
      if (found.located && measured > edge - grazing * line_deviation)
        errors.add(found, Eigen::Vector2d(k.pose.head<2>() + arm_in_base), line_deviation);
    }
    errors.print(is_box ? "box" : "circle");
    ASSERT_GT(errors.count, 1500);
    EXPECT_NEAR(errors.squared / errors.count, 1.0, 0.1);
    EXPECT_LT(errors.widest, is_box ? 2.0 * half.norm() : 2.0 * radius);
  }
}

TEST(LocateOnPlatform, IsOffByAsMuchAsItsDeviationSaysWhereLinesGrazeASphereInSpace) {
  const Hexapod robot(hexapod_robot());
  const Kinematics k = test::at_home(robot);
  constexpr double radius = 0.2, size = 40.0;
  const Outline outline({Sphere{.radius = radius}});
  const PlatformVector deviation{{0.5, 0.5, 0.5, 0.2, 0.2, 0.2}};
  const PlatformMatrix S = deviation.cwiseAbs2().asDiagonal();
  const double line_deviation = std::hypot(0.2, 0.5 * radius) / size;
  RandomGenerator random(5);
  const auto direction = [&random] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  GrazingErrors errors;
  for (int i = 0; i < 6000; ++i) {
    const Eigen::Vector3d n = direction();
    const Eigen::Vector3d side = n.cross(direction()).normalized();
    const double least = radius - 2.0 * grazing * line_deviation;  // uniform over the ring
    const double offset = std::sqrt(random.uniform(least * least, radius * radius));
    const Eigen::Vector3d arm = offset * side - std::sqrt(radius * radius - offset * offset) * n;
    PlatformVector wrench(6);
    wrench << size * n, arm.cross(size * n);
    for (int entry = 0; entry < 6; ++entry) wrench[entry] += deviation[entry] * random.normal();
    const LineOfAction line = line_of_action(robot.space(), wrench, 1.0);
    const ContactLocation found = locate_on_platform(robot, k, outline, wrench, S, S, 1.0);
    if (found.located && line.lever.norm() > radius - grazing * line_deviation)
      errors.add(found, Eigen::Vector3d(k.pose.head<3>() + arm), line_deviation);
  }
  errors.print("sphere in space");
  ASSERT_GT(errors.count, 1500);
  EXPECT_NEAR(errors.squared / errors.count, 1.0, 0.1);
  EXPECT_LT(errors.widest, 2.0 * radius);
}

TEST(LocateOnPlatform, IsAsUnsureAsTheLineThatSurelyMissesIt) {
  const Hexapod robot(hexapod_robot());
  constexpr double radius = 0.2, size = 40.0;
  const Outline outline({Sphere{.radius = radius}});
  const PlatformVector deviation{{1e-3, 1e-3, 1e-3, 0.01, 0.02, 0.01}};
  const PlatformMatrix S = deviation.cwiseAbs2().asDiagonal();
  // Beside the sphere, but within the square about it along both principal axes of the errors.
  const Eigen::Vector3d force(0.0, 0.0, -size), arm(0.8 * radius, 0.8 * radius, 0.0);
  PlatformVector wrench(6);
  wrench << force, arm.cross(force);
  const ContactLocation found = locate_on_platform(robot, test::at_home(robot), outline, wrench, S, S, 1.0);
  ASSERT_TRUE(found.valid);
  EXPECT_FALSE(found.located);
  EXPECT_NEAR(found.point_deviation, std::hypot(0.01, 0.02) / size, 1e-6);
}

TEST(LocateOnPlatform, IsAnywhereOnItWhereTheLineMayLieAnywhere) {
  const auto robot = test::touched_rig();
  const Kinematics k = test::at_home(*robot);
  const Outline outline({Box{.half_lengths = {0.01, 0.3, 0.01}}});
  const PlatformMatrix S = PlatformVector{{1.0, 1.0, 1e6}}.asDiagonal();
  const ContactLocation found =
      locate_on_platform(*robot, k, outline, PlatformVector{{-20.0, 0.0, 0.0}}, S, S, 1.0);
  ASSERT_TRUE(found.located);
  EXPECT_NEAR(found.point_deviation, 0.6 / std::sqrt(12.0), 0.02 * 0.6 / std::sqrt(12.0));
}

TEST(LocateOnPlatform, IsSureOfItsErrorsForForcesOfAnySize) {
  const auto rig = test::touched_rig();
  const Hexapod hexapod(hexapod_robot());
  for (double size = 1.0; size < 5e9; size *= 10.0) {  // as large as is usable
    for (const ParallelRobot* robot :
         {static_cast<const ParallelRobot*>(rig.get()), static_cast<const ParallelRobot*>(&hexapod)}) {
      PlatformVector wrench = PlatformVector::Constant(robot->dof(), 0.01);
      wrench[0] = -1.0;
      const PlatformMatrix S = WrenchUncertainty{.share_of_force = 0.0, .share_of_lever = 0.0}.covariance(
          robot->space(), size * wrench);
      const Outline outline(robot->body(BodyId::platform()).shapes);
      const ContactLocation found =
          locate_on_platform(*robot, test::at_home(*robot), outline, size * wrench, S, S, 0.5);
      EXPECT_TRUE(found.located) << size;
      EXPECT_GT(found.point_deviation, 0.0) << size;
      EXPECT_LT(found.point_deviation, 0.5) << size;
      EXPECT_TRUE(std::isfinite(found.residual)) << size;
    }
  }
}

TEST(LocateOnPlatform, LeavesOfTheWrenchWhatNoPushThereMakes) {
  const auto robot = test::touched_rig();
  const Kinematics k = test::at_home(*robot);
  const PlatformMatrix S = noise(*robot);
  EXPECT_LT(on_platform(*robot, k, PlatformVector{{-20.0, 3.0, 1.0}}).residual, 1e-20);
  // A line 0.3 m above the centre, of which 0.137 m are on the platform.
  EXPECT_NEAR(on_platform(*robot, k, PlatformVector{{-20.0, 0.0, 6.0}}).residual,
              std::pow(6.0 - 20.0 * 0.137, 2) / S(2, 2), 1e-9);
  const Hexapod hexapod(hexapod_robot());
  const PlatformVector push{{-30.0, 0.0, 0.0, 1.5, 0.0, 0.0}};  // with a moment about its own line
  EXPECT_NEAR(on_platform(hexapod, test::at_home(hexapod), push).residual, 1.5 * 1.5 / noise(hexapod)(3, 3),
              1e-9);
}

TEST(LocateOnPlatform, GivesTheNearestPointWhereTheLineMisses) {
  const auto robot = test::touched_rig();
  const Kinematics k = test::at_home(*robot);
  const ContactLocation found = on_platform(*robot, k, PlatformVector{{-20.0, 0.0, 6.0}});  // 0.3 m above
  EXPECT_TRUE(found.valid);
  EXPECT_FALSE(found.located);
  EXPECT_LT((found.point_in_base - CartesianVector(Eigen::Vector2d(0.0, 0.137))).norm(), 1e-12);
}

TEST(LocateOnPlatform, IsNotValidForAPureMoment) {
  const auto robot = test::touched_rig();
  EXPECT_FALSE(on_platform(*robot, test::at_home(*robot), PlatformVector{{0.3, 0.0, 6.0}}).valid);
}

TEST(LocateOnPlatform, KnowsNoPointOfAPlatformThatCannotTurnAndFindsThoseOfAPrism) {
  const FiveBar five_bar(five_bar_robot());
  const ContactLocation unknown = on_platform(five_bar, test::at_home(five_bar), PlatformVector{{10.0, 0.0}});
  EXPECT_TRUE(unknown.valid);
  EXPECT_FALSE(unknown.located);
  EXPECT_TRUE(unknown.point_in_base.allFinite());
  const double five_bar_radius = five_bar_robot().platform_radius;
  EXPECT_GT(unknown.point_deviation, 0.5 * five_bar_radius);
  EXPECT_LT(unknown.point_deviation, 2.0 * five_bar_radius);
  const Hexapod hexapod(hexapod_robot());
  const Kinematics k = test::at_home(hexapod);
  const PlatformVector push{{-30.0, 0.0, 0.0, 0.0, 0.0, 0.0}};  // through the origin of E, along -x
  const ContactLocation found = on_platform(hexapod, k, push);
  ASSERT_TRUE(found.located);
  const double radius = hexapod_robot().platform_radius;
  EXPECT_NEAR((found.point_in_base - k.pose.head<3>())[0], radius,
              0.05 * radius);  // a corner or a face of twelve
}

TEST(LocateOnLink, FindsThePointOnTheSurfaceThatIsPushed) {
  const auto robot = test::touched_rig();
  const Kinematics k = test::at_home(*robot);
  const BodyId link = BodyId::link2(1);
  const LinkContactMap map = link_contact_map(*robot, k, link);
  const PlatformVector wrench = test::wrench_on_link(*robot, k, link, 0.6, {0.0, 50.0});
  const PlatformMatrix S = 1e-4 * noise(*robot);
  const ContactLocation found =
      locate_on_link(map, link, PlatformVector::Zero(3), wrench, S, S, {.leaning = 0.0});
  ASSERT_TRUE(found.located);
  EXPECT_NEAR(found.fraction, 0.6, 1e-9);
  const CartesianVector expected =
      robot->point_on_body(k, link, Eigen::Vector2d(0.6 * map.length, -map.radius));
  EXPECT_LT((found.point_in_base - expected).norm(), 1e-9);
  EXPECT_NEAR(found.force_in_base.norm(), 50.0, 1e-9);
}

// Forces that lean by friction are not what the closed form assumes; its covariance covers them.
TEST(LocateOnLink, CoversForcesThatLean) {
  const auto robot = test::touched_rig();
  std::mt19937 generator(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  const auto states = test::random_kinematics(*robot, 500);
  const ContactLocatorSettings told{.least_force = 1.0, .largest_deviation = 0.1, .leaning = 0.2};
  int covered = 0;
  int count = 0;
  for (const Kinematics& k : states) {
    for (int leg = 0; leg < 3; ++leg) {
      const BodyId link = BodyId::link2(leg);
      const LinkContactMap map = link_contact_map(*robot, k, link);
      const double l = uniform(generator);
      PlatformVector wrench =
          test::wrench_on_link(*robot, k, link, l, {50.0 * 0.2 * normal(generator), 50.0});
      wrench += PlatformVector{{0.5 * normal(generator), 0.5 * normal(generator), 0.05 * normal(generator)}};
      const PlatformMatrix S = PlatformVector{{0.25, 0.25, 0.0025}}.asDiagonal();
      const ContactLocation found = locate_on_link(map, link, PlatformVector::Zero(3), wrench, S, S, told);
      if (!found.located) continue;
      ++count;
      const Eigen::Vector2d error(found.fraction - l, found.force_in_base.dot(map.axes.col(1)) - 50.0);
      covered +=
          error.dot(found.covariance.inverse() * error) < 5.991;  // 95 % of chi-square with two degrees
    }
  }
  ASSERT_GT(count, 300);
  std::printf("  leaning pushes covered: %d of %d\n", covered, count);
  EXPECT_GT(covered, 0.9 * count);
}

// A rough post stands still while the link slides along it: how hard it rubs is unknown, not to which side.
TEST(LocateOnLink, KnowsToWhichSideFrictionLeansWhereTheLinkSlides) {
  const auto robot = test::touched_rig();
  std::mt19937 generator(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  const ContactLocatorSettings told{.least_force = 1.0, .largest_deviation = 0.3, .leaning = 0.15};
  double knowing = 0.0, not_knowing = 0.0;  // squared errors
  int covered = 0, count = 0;
  for (const Kinematics& k : test::random_kinematics(*robot, 500)) {
    const BodyId link = BodyId::link2(0);
    const LinkContactMap map = link_contact_map(*robot, k, link);
    const double l = uniform(generator);
    PlatformVector velocity = PlatformVector::Zero(3);
    velocity.head(2) = (normal(generator) < 0.0 ? -1.0 : 1.0) * map.axes.col(0);
    const double sliding = (map.at_joint + l * map.along).col(0).dot(velocity);
    if (std::abs(sliding) < 0.6) continue;
    const double rubs = -std::copysign(0.15 * std::abs(normal(generator)), sliding);
    const PlatformVector wrench = test::wrench_on_link(*robot, k, link, l, {50.0 * rubs, 50.0});
    const PlatformMatrix S = PlatformVector{{0.01, 0.01, 0.0001}}.asDiagonal();
    const ContactLocation at_rest = locate_on_link(map, link, PlatformVector::Zero(3), wrench, S, S, told);
    const ContactLocation found = locate_on_link(map, link, velocity, wrench, S, S, told);
    if (!at_rest.located || !found.located) continue;
    ++count;
    knowing += std::pow(found.fraction - l, 2);
    not_knowing += std::pow(at_rest.fraction - l, 2);
    covered += std::abs(found.fraction - l) < 1.96 * std::sqrt(found.covariance(0, 0));
  }
  ASSERT_GT(count, 100);
  std::printf("  place off by %.3f of the link, %.3f without knowing the side\n", std::sqrt(knowing / count),
              std::sqrt(not_knowing / count));
  EXPECT_LT(knowing, std::pow(0.75, 2) * not_knowing) << "a known side and an unknown size leave 0.6";
  EXPECT_GT(covered, 0.9 * count);
}

struct Block {
  explicit Block(std::shared_ptr<const ParallelRobot> touched)
      : robot(std::move(touched)),
        block(builder.add<ContactLocator>("locator", robot, ContactLocatorSettings{}, WrenchUncertainty{})),
        phase(builder.export_input("phase", block.phase)),
        classification(builder.export_input("classification", block.classification)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        wrench(builder.export_input("wrench", block.wrench)),
        change(builder.export_input("change", block.change)),
        ticking(builder) {}

  ContactLocation see(int number, const PlatformVector& seen, bool active = true, bool valid = true) {
    const Kinematics k = test::at_home(*robot);
    ticking.set(phase, ContactPhase{active, {}});
    ContactClassification said;
    said.valid = valid;
    said.most_likely = number;
    ticking.set(classification, said);
    ticking.set(kinematics, k);
    ticking.set(wrench, test::estimate_of(k, seen));
    ticking.set(change, lately ? test::estimate_of(k, *lately) : WrenchEstimate());
    ticking.tick();
    return ticking.get(block.location);
  }

  DiagramBuilder builder;
  std::shared_ptr<const ParallelRobot> robot;
  ContactLocator& block;
  InputPort<ContactPhase> phase;
  InputPort<ContactClassification> classification;
  InputPort<Kinematics> kinematics;
  InputPort<WrenchEstimate> wrench, change;
  std::optional<PlatformVector> lately = PlatformVector::Zero(robot->dof());
  test::Ticking ticking;
};

TEST(ContactLocator, LocatesTheClassifiedBody) {
  Block locator(test::touched_rig());
  const PlatformVector push{{-40.0, 0.0, 1.0}};
  EXPECT_EQ(locator.see(0, push).body, 0);
  EXPECT_TRUE(locator.see(0, push).located);
  const ContactLocation first = locator.see(1, push);
  EXPECT_TRUE(first.valid);
  EXPECT_FALSE(first.located);  // a first link tells no place
}

TEST(ContactLocator, KnowsLessOfAForceThatGrowsButAsMuchOfItsPlace) {
  Block locator(test::touched_rig());
  const BodyId link = BodyId::link2(1);
  const PlatformVector push =
      test::wrench_on_link(*locator.robot, test::at_home(*locator.robot), link, 0.3, {0.0, 50.0});
  const ContactLocation steady = locator.see(link.index(), push);
  locator.lately = 0.3 * push;
  const ContactLocation grows = locator.see(link.index(), push);
  ASSERT_TRUE(steady.valid && grows.valid);
  EXPECT_EQ(grows.point_in_base, steady.point_in_base);
  EXPECT_NEAR(grows.force_deviation, std::hypot(steady.force_deviation, 2.0 * 0.3 * 50.0), 1e-6);
  EXPECT_NEAR(grows.point_deviation, steady.point_deviation, 1e-6);
  locator.lately =
      test::wrench_on_link(*locator.robot, test::at_home(*locator.robot), link, 0.9, {0.0, 15.0});
  EXPECT_GT(locator.see(link.index(), push).point_deviation, 1.5 * steady.point_deviation);
}

TEST(ContactLocator, SaysNothingWhereItIsNotKnownWhatTheEstimateIsBehindBy) {
  Block locator(test::touched_rig());
  locator.lately.reset();
  EXPECT_FALSE(locator.see(0, PlatformVector{{-40.0, 0.0, 1.0}}).valid);
}

TEST(ContactLocator, SaysNothingOfWhatIsNotClassifiedClampedOrGone) {
  Block locator(test::touched_rig());
  const PlatformVector push{{-40.0, 0.0, 1.0}};
  const test::AllocationCounter allocations;
  EXPECT_FALSE(locator.see(0, push, false).valid);
  EXPECT_FALSE(locator.see(0, push, true, false).valid);
  EXPECT_FALSE(locator.see(-1, push).valid);
  EXPECT_FALSE(locator.see(99, push).valid);
  EXPECT_FALSE(locator.see(7, push).valid);
  EXPECT_FALSE(locator.see(0, PlatformVector::Constant(3, std::numeric_limits<double>::quiet_NaN())).valid);
  EXPECT_FALSE(locator.see(2, PlatformVector{{0.0, 0.0, 4.0}}).valid);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(ContactLocator, AsksForPositiveSettings) {
  EXPECT_THROW(ContactLocator(test::touched_rig(), {.least_force = 0.0}, {}), SetupError);
  EXPECT_THROW(ContactLocator(test::touched_rig(), {}, {.force = -1.0}), SetupError);
}

}  // namespace
}  // namespace flinch
