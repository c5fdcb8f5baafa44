#include "tests/learning/contact_examples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "systems/config/robot_file.h"
#include "systems/framework/random.h"

namespace flinch::test {
namespace {

constexpr double stiffest = 1e5;  // of what is touched in the data of the shipped models [N/m]

Eigen::Vector2d across(const ParallelRobot& robot, const Kinematics& now, BodyId link) {
  const Eigen::Vector2d axis = robot.point_on_body(now, link, robot.axis_point(link, 1.0)) -
                               robot.point_on_body(now, link, robot.axis_point(link, 0.0));
  return Eigen::Vector2d(-axis.y(), axis.x()).normalized();
}

/// Where a body is touched: the wrench of 1 N there, and how fast the place moves against it [m/s].
struct Touched {
  PlatformVector wrench;
  double speed = 0.0;
};

Touched touched_at(const ParallelRobot& robot, const Kinematics& now, BodyId body,
                   const CartesianVector& point, const Eigen::Vector2d& outwards) {
  const ContactJacobian jacobian = robot.contact_jacobian(now, body, point);
  return {platform_wrench(jacobian, CartesianVector(-outwards)),
          (jacobian.translation * now.velocity).dot(outwards)};
}

/// The platform in the direction of its motion; a link on the side to which the place moves.
Touched collision(const ParallelRobot& robot, const Kinematics& now, BodyId body, double fraction) {
  if (body.is_platform()) {
    const Eigen::Vector2d outwards = now.velocity.head<2>().normalized();
    return touched_at(robot, now, body, 0.05 * outwards, outwards);
  }
  const Eigen::Vector2d normal = across(robot, now, body);
  const Touched there = touched_at(robot, now, body, robot.axis_point(body, fraction), normal);
  return there.speed > 0.0 ? there : touched_at(robot, now, body, robot.axis_point(body, fraction), -normal);
}

/// How fast the middles of both links of a leg move towards one another: half as fast as its ends [m/s].
double closing_speed(const ParallelRobot& robot, const Kinematics& now, int leg) {
  const BodyId link = BodyId::link2(leg);
  const CartesianVector velocity =
      robot.contact_jacobian(now, link, robot.axis_point(link, 1.0)).translation * now.velocity;
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  return -0.5 * velocity.dot((points.coupling_joint - points.base_joint).normalized());
}

/// The middles of both links of a leg, on their sides to one another.
std::array<Touched, 2> clamping(const ParallelRobot& robot, const Kinematics& now, int leg) {
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  const Eigen::Vector2d middle = 0.5 * (points.base_joint + points.coupling_joint);
  const auto inside = [&](BodyId link) {
    const CartesianVector point = robot.axis_point(link, 0.5);
    const Eigen::Vector2d normal = across(robot, now, link);
    const bool is_inwards = (middle - robot.point_on_body(now, link, point)).dot(normal) > 0.0;
    return touched_at(robot, now, link, point, is_inwards ? normal : Eigen::Vector2d(-normal));
  };
  return {inside(BodyId::link1(leg)), inside(BodyId::link2(leg))};
}

/// The places that are touched, and how fast what touches them is run into [m/s].
struct Contact {
  std::array<Touched, 2> places;
  double speed = 0.0;
};

Contact contact_of(const ParallelRobot& robot, const Kinematics& now, int touched, double fraction) {
  const ContactClasses classes = classes_of(robot);
  if (classes.is_clamping(touched)) {
    const int leg = classes.leg(touched);
    return {clamping(robot, now, leg), closing_speed(robot, now, leg)};
  }
  const Touched place = collision(robot, now, ContactClasses::body(touched), fraction);
  return {{place, {PlatformVector::Zero(robot.dof())}}, place.speed};
}

}  // namespace

DataSet contact_examples(int count, std::uint64_t seed) {
  const std::string file = FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml";
  std::ifstream stream(file);
  DataSet data;
  data.robot_file = "planar_3rrr.yaml";
  data.robot_text = {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  data.robot = parse_robot_file(data.robot_text, file).robot;
  data.card = {{"title", "Examples"}, {"seed", std::to_string(seed)}, {"samples", "decisions"}};
  const ParallelRobot& robot = *data.robot;
  const ContactClasses classes = classes_of(robot);
  RandomGenerator random(seed);
  for (int i = 0; i < count; ++i) {
    DataSample sample;
    sample.run = i;
    sample.configuration = i % 3;
    sample.moment = Moment::early | Moment::detected | Moment::later;
    sample.touched = i % classes.count();
    sample.pose = robot.home_pose();
    for (double& coordinate : sample.pose) coordinate += random.uniform(-0.05, 0.05);
    sample.force = random.uniform(30.0, 80.0);
    const double fraction = random.uniform(0.3, 0.9);
    std::array since{random.uniform(3.0, 8.0), random.uniform(3.0, 8.0)};  // of 5 ms
    if (!classes.is_clamping(sample.touched)) since[1] = since[0];
    const double least_speed = sample.force / (stiffest * 5e-3 * std::min(since[0], since[1]));
    Contact contact;
    Kinematics now;
    PlatformVector velocity;
    do {
      const double direction = random.uniform(-M_PI, M_PI);
      velocity = Eigen::Vector3d(0.5 * std::cos(direction), 0.5 * std::sin(direction), 0.0);
      robot.kinematics(sample.pose, velocity, now);
      contact = contact_of(robot, now, sample.touched, fraction);
    } while (contact.speed < least_speed);
    Dynamics dynamics;
    robot.dynamics(now, dynamics);
    for (std::size_t k = 0; k < window_ages.size(); ++k) {
      const double ago = static_cast<double>(window_ages[k] / 1ms);
      PlatformVector wrench = PlatformVector::Zero(robot.dof()), since_then = wrench;
      for (std::size_t place = 0; place < since.size(); ++place) {
        const double lasts = 5.0 * since[place], of = std::min(ago, lasts);  // [ms]
        const PlatformVector whole = sample.force * contact.places[place].wrench;
        wrench += (1.0 - of / lasts) * whole;
        since_then += 1e-3 * of * (1.0 - 0.5 * of / lasts) * whole;
      }
      wrench += Eigen::Vector3d(0.5 * random.normal(), 0.5 * random.normal(), 0.05 * random.normal());
      sample.course[k] = {wrench, velocity - dynamics.M_x.inverse() * since_then};
    }
    data.samples.push_back(sample);
  }
  return data;
}

}  // namespace flinch::test
