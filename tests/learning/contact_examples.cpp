#include "tests/learning/contact_examples.h"

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

/// Equal forces that push both links apart, as far from the elbow on both.
PlatformVector clamping(const ParallelRobot& robot, const Kinematics& now, int leg, double size) {
  PlatformVector wrench = PlatformVector::Zero(robot.dof());
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  const CartesianVector middle = 0.5 * (points.base_joint + points.coupling_joint);
  for (const BodyId link : {BodyId::link1(leg), BodyId::link2(leg)}) {
    const CartesianVector point = robot.axis_point(link, 0.5);
    const Eigen::Vector2d normal = across(robot, now, link);
    const Eigen::Vector2d inwards = middle - robot.point_on_body(now, link, point);
    const double side = inwards.dot(normal) > 0.0 ? -1.0 : 1.0;
    wrench +=
        platform_wrench(robot.contact_jacobian(now, link, point), CartesianVector(side * size * normal));
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
    const double direction = random.uniform(-M_PI, M_PI);
    sample.velocity = Eigen::Vector3d(0.5 * std::cos(direction), 0.5 * std::sin(direction), 0.0);
    Kinematics now;
    robot.kinematics(sample.pose, sample.velocity, now);
    sample.force = random.uniform(30.0, 80.0);
    sample.wrench_in_base =
        classes.is_clamping(sample.touched)
            ? clamping(robot, now, classes.leg(sample.touched), sample.force)
            : collision(robot, now, ContactClasses::body(sample.touched), sample.force, random);
    sample.change = sample.change_before = 0.3 * sample.wrench_in_base;
    for (PlatformVector* wrench : {&sample.wrench_in_base, &sample.change, &sample.change_before})
      *wrench += Eigen::Vector3d(0.5 * random.normal(), 0.5 * random.normal(), 0.05 * random.normal());
    data.samples.push_back(sample);
  }
  return data;
}

}  // namespace flinch::test
