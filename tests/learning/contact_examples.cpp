#include "tests/learning/contact_examples.h"

#include <array>
#include <cmath>
#include <fstream>

#include "systems/config/robot_file.h"
#include "systems/framework/random.h"

namespace flinch::test {
namespace {

Eigen::Vector2d across(const ParallelRobot& robot, const Kinematics& now, BodyId link) {
  const Eigen::Vector2d axis = robot.point_on_body(now, link, robot.axis_point(link, 1.0)) -
                               robot.point_on_body(now, link, robot.axis_point(link, 0.0));
  return Eigen::Vector2d(-axis.y(), axis.x()).normalized();
}

/// A force of `size` on a body, against which the point moves that it acts on.
PlatformVector collision(const ParallelRobot& robot, const Kinematics& now, BodyId body, double size,
                         RandomGenerator& random) {
  if (body.is_platform()) {
    const Eigen::Vector2d velocity = now.velocity.head<2>();
    const Eigen::Vector2d outwards = velocity.normalized();
    const ContactJacobian jacobian = robot.contact_jacobian(now, body, 0.05 * outwards);
    return platform_wrench(jacobian, CartesianVector(-size * outwards));
  }
  const CartesianVector point = robot.axis_point(body, random.uniform(0.3, 0.9));
  const ContactJacobian jacobian = robot.contact_jacobian(now, body, point);
  const Eigen::Vector2d normal = across(robot, now, body);
  const double side = (jacobian.translation * now.velocity).dot(normal) > 0.0 ? -1.0 : 1.0;
  return platform_wrench(jacobian, CartesianVector(side * size * normal));
}

/// How fast base and coupling joint of the leg move towards one another [m/s].
double closing_speed(const ParallelRobot& robot, const Kinematics& now, int leg) {
  const BodyId link = BodyId::link2(leg);
  const CartesianVector velocity =
      robot.contact_jacobian(now, link, robot.axis_point(link, 1.0)).translation * now.velocity;
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  return -velocity.dot((points.coupling_joint - points.base_joint).normalized());
}

/// A wrench now, 5 ms ago and 10 ms ago.
using Growing = std::array<PlatformVector, 3>;

/// Equal forces that push both links apart, as far from the elbow on both. That on the first link has grown
/// for 25 ms, that on the second, which came later, for 15 ms.
Growing clamping(const ParallelRobot& robot, const Kinematics& now, int leg, double size) {
  Growing wrench;
  wrench.fill(PlatformVector::Zero(robot.dof()));
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  const CartesianVector middle = 0.5 * (points.base_joint + points.coupling_joint);
  for (const BodyId link : {BodyId::link1(leg), BodyId::link2(leg)}) {
    const CartesianVector point = robot.axis_point(link, 0.5);
    const Eigen::Vector2d normal = across(robot, now, link);
    const Eigen::Vector2d inwards = middle - robot.point_on_body(now, link, point);
    const double side = inwards.dot(normal) > 0.0 ? -1.0 : 1.0;
    const PlatformVector whole =
        platform_wrench(robot.contact_jacobian(now, link, point), CartesianVector(side * size * normal));
    for (std::size_t i = 0; i < wrench.size(); ++i) {
      const double since = (link.is_link1() ? 5.0 : 3.0) - static_cast<double>(i);  // of 5 ms
      wrench[i] += since / (link.is_link1() ? 5.0 : 3.0) * whole;
    }
  }
  return wrench;
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
    Kinematics now;
    const int leg = classes.is_clamping(sample.touched) ? classes.leg(sample.touched) : -1;
    do {
      const double direction = random.uniform(-M_PI, M_PI);
      sample.velocity = Eigen::Vector3d(0.5 * std::cos(direction), 0.5 * std::sin(direction), 0.0);
      robot.kinematics(sample.pose, sample.velocity, now);
    } while (leg >= 0 && closing_speed(robot, now, leg) < 0.25);
    sample.force = random.uniform(30.0, 80.0);
    Growing wrench;
    if (leg >= 0) {
      wrench = clamping(robot, now, leg, sample.force);
    } else {
      wrench[0] = collision(robot, now, ContactClasses::body(sample.touched), sample.force, random);
      wrench[1] = 2.0 / 3.0 * wrench[0];
      wrench[2] = 1.0 / 3.0 * wrench[0];
    }
    sample.wrench_in_base = wrench[0];
    sample.change = wrench[0] - wrench[1];
    sample.change_before = wrench[1] - wrench[2];
    for (PlatformVector* noisy : {&sample.wrench_in_base, &sample.change, &sample.change_before})
      *noisy += Eigen::Vector3d(0.5 * random.normal(), 0.5 * random.normal(), 0.05 * random.normal());
    data.samples.push_back(sample);
  }
  return data;
}

}  // namespace flinch::test
