#include "systems/contact/touch_hypotheses.h"
#include "systems/robot/decompositions.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include "systems/config/robot_file.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/outline.h"
#include "tests/support/allocations.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

using ::testing::AnyOf;
using ::testing::Eq;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

PlatformMatrix noise(const ParallelRobot& robot) {
  return WrenchUncertainty{.force = 0.5, .moment = 0.05}.covariance(robot.space(),
                                                                    PlatformVector::Zero(robot.dof()));
}

/// Of the first `classes` classes, or all.
int likeliest(const ContactEvidence& evidence, Eigen::Index classes = 0) {
  Eigen::Index best = 0;
  evidence.log_evidence.head(classes > 0 ? classes : evidence.log_evidence.size()).maxCoeff(&best);
  return static_cast<int>(best);
}

// A half-normal force times a Gaussian wrench, integrated over the force by the trapezoidal rule, for a
// platform that is touched at one point without friction: the closed form, but for how likely that point is.
TEST(TouchHypotheses, MarginaliseTheForceAsAnIntegralDoes) {
  const auto robot = test::touched_rig();
  const Kinematics k = test::at_home(*robot);
  const TouchHypotheses hypotheses(robot, {.friction = 0.0, .points_along = 1, .points_around = 1});
  const PlatformMatrix inverse = noise(*robot).inverse();
  const auto integral = [&](const PlatformVector& wrench) {
    constexpr double scale = 50.0, step = 1e-3;
    double sum = 0.0;
    for (int i = 0; i <= 200000; ++i) {
      const double a = i * step;
      const Eigen::Vector3d missed = wrench + a * Eigen::Vector3d::UnitX();  // pushed at (R, 0) along -x
      const double likelihood = std::exp(-0.5 * missed.dot(inverse * missed));
      sum += (i == 0 ? 0.5 : 1.0) * likelihood * std::exp(-0.5 * a * a / (scale * scale)) * step;
    }
    return std::log(2.0 * sum / (scale * std::sqrt(2.0 * std::numbers::pi)));
  };
  const auto difference = [&](double force) {
    const PlatformVector wrench{{-force, 0.4, 0.03}};
    ContactEvidence evidence;
    hypotheses.weigh(k, wrench, noise(*robot), evidence);
    return evidence.log_evidence[0] - integral(wrench);
  };
  const double of_the_point = difference(20.0);
  for (const double force : {-3.0, 0.5, 60.0}) EXPECT_NEAR(difference(force), of_the_point, 1e-4) << force;
}

/// From the platform's or a link's frame to the base.
Eigen::Vector3d in_base(const ParallelRobot& robot, const Kinematics& k, BodyId body,
                        const Eigen::Vector3d& point) {
  const CartesianVector placed = robot.point_on_body(k, body, point.head(robot.space_dimension()));
  Eigen::Vector3d whole = Eigen::Vector3d::Zero();
  whole.head(placed.size()) = placed;
  return whole;
}

/// Whether the point lies in another body.
bool is_inside(const ParallelRobot& robot, const Kinematics& k, BodyId of, const Eigen::Vector3d& point) {
  for (int i = 0; i < robot.body_count(); ++i) {
    const BodyId body = BodyId::from_index(i);
    for (const Shape& shape : robot.body(body).shapes) {
      if (body == of) continue;
      const auto* sphere = std::get_if<Sphere>(&shape);
      if (sphere != nullptr && (point - in_base(robot, k, body, sphere->centre)).norm() < sphere->radius)
        return true;
      const auto* capsule = std::get_if<Capsule>(&shape);
      if (capsule == nullptr) continue;
      const Eigen::Vector3d begin = in_base(robot, k, body, capsule->begin);
      const Eigen::Vector3d axis = in_base(robot, k, body, capsule->end) - begin;
      const double along = std::clamp((point - begin).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
      if ((point - begin - along * axis).norm() < capsule->radius) return true;
    }
  }
  return false;
}

/// ln of the likelihood of a wrench on a link of a robot at rest, without friction: place by place, by the
/// contact Jacobian of each.
double evidence_of_link(const ParallelRobot& robot, const Kinematics& k, BodyId link,
                        const PlatformVector& wrench, const TouchHypothesesSettings& settings) {
  const PlatformMatrix inverse = noise(robot).inverse();
  const auto& capsule = std::get<Capsule>(robot.body(link).shapes.front());
  const int dimension = robot.space_dimension(), sides = dimension == 2 ? 2 : settings.sides_in_space;
  const int along = dimension == 2 ? settings.points_along : settings.places_along_in_space;
  const Eigen::Vector3d axis = (capsule.end - capsule.begin).normalized();
  const Eigen::Vector3d across =
      dimension == 2 ? Eigen::Vector3d::UnitZ().cross(axis) : axis.unitOrthogonal();
  const double at_rest = settings.object_speed / std::sqrt(2.0 * std::numbers::pi);
  double sum = 0.0;
  for (int side = 0; side < sides; ++side) {
    const Eigen::Vector3d normal =
        Eigen::AngleAxisd(2.0 * std::numbers::pi * side / sides, axis).toRotationMatrix() * across;
    for (int i = 0; i < along; ++i) {
      const double fraction = (i + 0.5) / along;
      const Eigen::Vector3d point =
          capsule.begin + fraction * (capsule.end - capsule.begin) + capsule.radius * normal;
      if (is_inside(robot, k, link, in_base(robot, k, link, point))) continue;
      const CartesianVector push =
          -(in_base(robot, k, link, normal) - in_base(robot, k, link, Eigen::Vector3d::Zero()))
               .head(dimension);
      const PlatformVector h =
          robot.contact_jacobian(k, link, point.head(dimension)).translation.transpose() * push;
      const double s = 1.0 / std::sqrt(h.dot(inverse * h) + std::pow(settings.force_scale, -2.0));
      const double m = s * s * h.dot(inverse * wrench);
      sum += 2.0 * s / settings.force_scale * std::exp(0.5 * m * m / (s * s)) * 0.5 *
             std::erfc(-m / s / std::numbers::sqrt2);
    }
  }
  return std::log(at_rest * sum / (sides * along)) - 0.5 * wrench.dot(inverse * wrench);
}

TEST(TouchHypotheses, SumOverALinkWhatItsPlacesSay) {
  const std::shared_ptr<const ParallelRobot> robots[] = {test::touched_rig(),
                                                         std::make_shared<Hexapod>(hexapod_robot())};
  const TouchHypothesesSettings settings{.object_radius = 1e-9,
                                         .softness = 1e-9,
                                         .friction = 0.0,
                                         .points_along = 5,
                                         .sides_in_space = 12,
                                         .places_along_in_space = 5};
  for (const auto& robot : robots) {
    const TouchHypotheses hypotheses(robot, settings);
    const Kinematics k = test::at_home(*robot);
    for (const BodyId link : {BodyId::link1(0), BodyId::link2(1)}) {
      const LinkContactMap map = link_contact_map(*robot, k, link);
      const PlatformVector wrench =
          (map.at_joint + 0.7 * map.along) * (8.0 * CartesianVector::Unit(map.axes.cols(), 1));
      ContactEvidence evidence;
      hypotheses.weigh(k, wrench, noise(*robot), evidence);
      EXPECT_NEAR(evidence.log_evidence[ContactClasses::collision(link)],
                  evidence_of_link(*robot, k, link, wrench, settings), 1e-7)
          << robot->name();
    }
  }
}

/// Of exact contacts of 40 N in random states, the share whose class has the greatest evidence of all bodies.
template <class Touch>
double recognised(const std::vector<Kinematics>& states, const Touch& touch) {
  const auto robot = test::touched_rig();
  const TouchHypotheses hypotheses(robot, {});
  int right = 0;
  int count = 0;
  for (const Kinematics& k : states) {
    for (int leg = 0; leg < 3; ++leg) {
      const auto [wrench, expected] = touch(*robot, k, leg);
      ContactEvidence evidence;
      hypotheses.weigh(k, wrench, noise(*robot), evidence);
      EXPECT_TRUE(evidence.valid);
      EXPECT_LT(evidence.residual[expected], 3.0);  // an exact contact between two points of the grid
      right += likeliest(evidence, 7) == expected;
      ++count;
    }
  }
  return static_cast<double>(right) / count;
}

TEST(TouchHypotheses, RecogniseFirstLinksThatMoveTowardsWhatTheyTouch) {
  const auto states = test::random_kinematics(*test::touched_rig(), 100);
  const double share = recognised(states, [](const PlanarRrr& robot, const Kinematics& k, int leg) {
    const double side = k.rates.active[leg] > 0.0 ? -1.0 : 1.0;  // against the motion
    return std::pair(test::wrench_on_link(robot, k, BodyId::link1(leg), 0.7, {0.0, 40.0 * side}),
                     ContactClasses::collision(BodyId::link1(leg)));
  });
  EXPECT_GT(share, 0.9);
}

TEST(TouchHypotheses, RecogniseSecondLinksThatMoveTowardsWhatTheyTouch) {
  const auto states = test::random_kinematics(*test::touched_rig(), 100);
  const double share = recognised(states, [](const PlanarRrr& robot, const Kinematics& k, int leg) {
    const BodyId link = BodyId::link2(leg);
    const LegPoints& points = k.legs[static_cast<std::size_t>(leg)];
    const Eigen::Vector2d across =
        normal(Eigen::Vector2d(points.coupling_joint - points.passive_joint).normalized());
    const CartesianVector velocity =
        robot.contact_jacobian(k, link, robot.axis_point(link, 0.6)).translation * k.velocity;
    const double side = across.dot(Eigen::Vector2d(velocity)) > 0.0 ? -1.0 : 1.0;
    return std::pair(test::wrench_on_link(robot, k, link, 0.6, {0.0, 40.0 * side}),
                     ContactClasses::collision(link));
  });
  EXPECT_GT(share, 0.9);
}

TEST(TouchHypotheses, PlaceAPushOnASecondLinkWhereItIs) {
  const auto robot = test::touched_rig();
  const TouchHypotheses hypotheses(robot, {.friction = 0.0});
  const Kinematics k = test::at_home(*robot);
  for (const double fraction : {0.35, 0.6, 0.85}) {
    ContactEvidence evidence;
    hypotheses.weigh(k, test::wrench_on_link(*robot, k, BodyId::link2(1), fraction, {0.0, -40.0}),
                     noise(*robot), evidence);
    const int number = ContactClasses::collision(BodyId::link2(1));
    EXPECT_NEAR(evidence.location[number], fraction, 0.03);
    EXPECT_NEAR(evidence.force[number], 40.0, 2.0);
  }
}

TEST(TouchHypotheses, FindClampingWhereBothLinksCloseOnSomething) {
  const auto robot = test::touched_rig();
  const TouchHypotheses hypotheses(robot, {});
  int right = 0;
  int count = 0;
  for (const Kinematics& k : test::random_kinematics(*robot, 300)) {
    if (k.rates.passive[0] < 1.0) continue;  // the leg folds
    const PlatformVector wrench = test::wrench_on_link(*robot, k, BodyId::link1(0), 0.7, {0.0, -40.0}) +
                                  test::wrench_on_link(*robot, k, BodyId::link2(0), 0.28, {0.0, -40.0});
    ContactEvidence evidence;
    hypotheses.weigh(k, wrench, noise(*robot), evidence);
    right += likeliest(evidence) == hypotheses.classes().clamping(0);
    ++count;
  }
  ASSERT_GT(count, 30);
  std::printf("  clamped: %d of %d\n", right, count);
  EXPECT_GT(right, 0.8 * count);
}

TEST(TouchHypotheses, TellByTheResidualThatNoSingleContactMakesAWrench) {
  const auto robot = test::touched_rig();
  const TouchHypotheses hypotheses(robot, {});
  const Kinematics k = test::at_home(*robot);
  ContactEvidence evidence;
  hypotheses.weigh(k, PlatformVector{{5.0, 0.0, 10.0}}, noise(*robot), evidence);  // 2 m off the platform
  EXPECT_GT(evidence.residual.minCoeff(), 100.0);
}

TEST(TouchHypotheses, ServeOtherMechanisms) {
  const std::shared_ptr<const ParallelRobot> robots[] = {std::make_shared<FiveBar>(five_bar_robot()),
                                                         std::make_shared<Hexapod>(hexapod_robot())};
  for (const auto& robot : robots) {
    const TouchHypotheses hypotheses(robot, {});
    const Kinematics k = test::at_home(*robot);
    for (const BodyId link : {BodyId::link1(0), BodyId::link2(1)}) {
      const LinkContactMap map = link_contact_map(*robot, k, link);
      const PlatformVector wrench =
          (map.at_joint + 0.8 * map.along) * (60.0 * CartesianVector::Unit(map.axes.cols(), 1));
      ContactEvidence evidence;
      hypotheses.weigh(k, wrench, noise(*robot), evidence);
      ASSERT_TRUE(evidence.valid);
      EXPECT_EQ(evidence.log_evidence.size(), robot->body_count() + robot->legs());
      EXPECT_EQ(hypotheses.classes().leg(likeliest(evidence)), link.leg()) << robot->name();
    }
  }
}

/// A push of 40 N on a robot in space that moves, at a random place that moves towards what it touches, with
/// random friction against the sliding; none: it does not at this place.
struct PushInSpace {
  Kinematics kinematics;
  PlatformVector wrench;
};
std::optional<PushInSpace> random_push(const ParallelRobot& robot, BodyId body, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> random(-1.0, 1.0);
  const auto draw = [&](int size) {
    return PlatformVector::NullaryExpr(size, [&](Eigen::Index) { return random(generator); });
  };
  const Kinematics k =
      test::kinematics_of(robot, robot.space().plus(robot.home_pose(), 0.05 * draw(6)), 0.4 * draw(6));
  const Shape& shape = robot.body(body).shapes.front();
  const Outline outline({shape});
  const auto* const capsule = std::get_if<Capsule>(&shape);
  const Eigen::Vector3d inside = capsule == nullptr
                                     ? Eigen::Vector3d::Zero()
                                     : Eigen::Vector3d(capsule->begin + (0.5 + 0.4 * random(generator)) *
                                                                            (capsule->end - capsule->begin));
  const Eigen::Vector3d ray = draw(3).normalized();
  const Eigen::Vector3d point = inside + outline.passage(inside, ray).leave * ray;
  const Eigen::Vector3d normal =
      in_base(robot, k, body, point + outline.normal_at(point)) - in_base(robot, k, body, point);
  const ContactJacobian J = robot.contact_jacobian(k, body, point);
  const Eigen::Vector3d velocity = J.translation * k.velocity;
  if (velocity.dot(normal) < 0.05) return std::nullopt;
  const Eigen::Vector3d sliding = (velocity - velocity.dot(normal) * normal).normalized();
  const Eigen::Vector3d force = -40.0 * (normal + 0.15 * (1.0 + random(generator)) * sliding).normalized();
  return PushInSpace{k, J.translation.transpose() * force};
}

/// Of random pushes on some body of each leg, or the platform, the share of which that leg, or it, is said.
double told_in_space(const ParallelRobot& robot, const TouchHypotheses& hypotheses, bool platform) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  int right = 0, count = 0;
  while (count < 200) {
    const BodyId body =
        platform ? BodyId::platform() : BodyId::from_index(1 + static_cast<int>(generator() % 12));
    auto push = random_push(robot, body, generator);
    if (!push) continue;
    for (int i = 0; i < 6; ++i) push->wrench[i] += (i < 3 ? 0.5 : 0.05) * normal(generator);
    ContactEvidence evidence;
    hypotheses.weigh(push->kinematics, push->wrench, noise(robot), evidence);
    EXPECT_TRUE(evidence.valid);
    right +=
        hypotheses.classes().leg(likeliest(evidence, robot.body_count())) == (platform ? -1 : body.leg());
    ++count;
  }
  return static_cast<double>(right) / count;
}

TEST(TouchHypotheses, TellThePlatformFromTheLegsOfRobotsInSpace) {
  const std::shared_ptr<const ParallelRobot> robots[] = {
      std::make_shared<Hexapod>(hexapod_robot()),
      read_robot_file(FLINCH_SOURCE_DIR "/apps/robots/hexa_6rus.yaml").robot};
  for (const auto& robot : robots) {
    const TouchHypotheses hypotheses(robot, {});
    const double platform = told_in_space(*robot, hypotheses, true),
                 legs = told_in_space(*robot, hypotheses, false);
    std::printf("  %s: platform told %.3f, leg told %.3f\n", robot->name().c_str(), platform, legs);
    EXPECT_GE(platform, 0.95) << robot->name();
    EXPECT_GE(legs, 0.95) << robot->name();
  }
}

TEST(TouchHypotheses, AreNotValidForUnusableInput) {
  const auto robot = test::touched_rig();
  const TouchHypotheses hypotheses(robot, {});
  const Kinematics k = test::at_home(*robot);
  const PlatformVector good{{20.0, 0.0, 0.0}};
  const PlatformMatrix S = noise(*robot);
  const auto weigh = [&](const Kinematics& at, const PlatformVector& wrench,
                         const PlatformMatrix& covariance) {
    ContactEvidence evidence;
    hypotheses.weigh(at, wrench, covariance, evidence);
    EXPECT_TRUE(evidence.log_evidence.allFinite());
    EXPECT_EQ(evidence.location.size(), 10);
    return evidence.valid;
  };
  EXPECT_TRUE(weigh(k, good, S));
  EXPECT_TRUE(weigh(k, PlatformVector::Zero(3), S));
  EXPECT_FALSE(weigh(Kinematics(), good, S));
  EXPECT_FALSE(weigh(k, PlatformVector::Constant(3, nan), S));
  EXPECT_FALSE(weigh(k, PlatformVector::Zero(2), S));
  EXPECT_FALSE(weigh(k, good, PlatformMatrix::Zero(3, 3)));
}

TEST(TouchHypotheses, NeverAllocate) {
  const std::shared_ptr<const ParallelRobot> robots[] = {test::touched_rig(),
                                                         std::make_shared<Hexapod>(hexapod_robot())};
  for (const auto& robot : robots) {
    const TouchHypotheses hypotheses(robot, {});
    const Kinematics k = test::at_home(*robot);
    const PlatformMatrix S = noise(*robot);
    PlatformVector wrench = PlatformVector::Constant(robot->dof(), 0.5);
    wrench[0] = 20.0;
    ContactEvidence evidence;
    const test::AllocationCounter allocations;
    hypotheses.weigh(k, wrench, S, evidence);
    EXPECT_EQ(allocations.count(), 0);
    EXPECT_TRUE(evidence.valid);
  }
}

TEST(TouchHypotheses, AskForPositiveSettings) {
  EXPECT_THROW(TouchHypotheses(test::touched_rig(), {.force_scale = 0.0}), SetupError);
  EXPECT_THROW(TouchHypotheses(test::touched_rig(), {.points_around = 0}), SetupError);
  EXPECT_THROW(TouchHypotheses(test::touched_rig(), {.places_in_space = 0}), SetupError);
}

}  // namespace
}  // namespace flinch
