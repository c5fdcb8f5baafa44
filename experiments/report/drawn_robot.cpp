#include "experiments/report/drawn_robot.h"

#include <algorithm>
#include <array>
#include <limits>

#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr std::array axes{"x", "y", "z"};

ReportPoint in_space(const CartesianVector& v) { return {v[0], v[1], v.size() == 3 ? v[2] : 0.0}; }

ReportPoint in_space(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Kinematics at_rest(const ParallelRobot& robot, const Configuration& pose) {
  Kinematics kinematics;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), kinematics);
  return kinematics;
}

/// The point of the platform frame that is at `point` in the base frame.
CartesianVector in_platform(const ParallelRobot& robot, const Kinematics& at, const CartesianVector& point) {
  const int n = robot.space_dimension();
  const CartesianVector origin = robot.point_on_body(at, BodyId::platform(), CartesianVector::Zero(n));
  CartesianVector result(n);
  for (int i = 0; i < n; ++i) {
    const CartesianVector tip = robot.point_on_body(at, BodyId::platform(), CartesianVector::Unit(n, i));
    result[i] = (tip - origin).dot(point - origin);
  }
  return result;
}

/// The thickness of a body's first capsule; 0 where it has none.
double capsule_radius(const Body& body) {
  for (const Shape& shape : body.shapes) {
    if (const auto* const capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
  }
  return 0.0;
}

/// The hull of `points`, grown by `radius`.
struct DrawnOutline {
  std::vector<Eigen::Vector3d> points;
  double radius = 0.0;
};

DrawnOutline outline_of(const Shape& shape) {
  if (const auto* const sphere = std::get_if<Sphere>(&shape)) return {{sphere->centre}, sphere->radius};
  if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    return {{capsule->begin, capsule->end}, capsule->radius};
  }
  if (const auto* const hull = std::get_if<ConvexHull>(&shape)) return {hull->points, hull->margin};
  const Box& box = std::get<Box>(shape);
  DrawnOutline outline;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    outline.points.emplace_back(box.centre + box.axes * signs.cwiseProduct(box.half_lengths));
  }
  return outline;
}

/// The pose at a sample from its columns; of another size where the report has others.
Configuration pose_at(const ConfigurationSpace& space, const Report& report, std::size_t sample) {
  Configuration pose(space.stored());
  int i = 0;
  for (const char* const name :
       {"pose_x", "pose_y", "pose_z", "pose_phi", "pose_qw", "pose_qx", "pose_qy", "pose_qz"}) {
    const auto column = report.columns.find(name);
    if (column != report.columns.end() && i < pose.size()) pose[i++] = column->second[sample];
  }
  return i == pose.size() ? pose : Configuration();
}

}  // namespace

ReportRobot drawn_robot(const ParallelRobot& robot) {
  ReportRobot drawn;
  const Kinematics home = at_rest(robot, robot.home_pose());
  for (int i = 0; i < robot.legs(); ++i) {
    const LegPoints& leg = home.legs[static_cast<std::size_t>(i)];
    drawn.legs.push_back({in_space(leg.base_joint), in_space(in_platform(robot, home, leg.coupling_joint))});
  }
  for (int i = 1; i < robot.body_count(); ++i) {
    drawn.link_radius = std::max(drawn.link_radius, capsule_radius(robot.body(BodyId::from_index(i))));
  }
  for (const Shape& shape : robot.body(BodyId::platform()).shapes) {
    const DrawnOutline outline = outline_of(shape);
    for (const Eigen::Vector3d& point : outline.points) drawn.platform.push_back(in_space(point));
    drawn.platform_radius = std::max(drawn.platform_radius, outline.radius);
  }
  if (drawn.platform.empty()) drawn.platform.push_back({});
  return drawn;
}

ReportObstacle drawn_obstacle(const std::string& name, const Shape& shape, const Eigen::Vector3d& position) {
  const DrawnOutline outline = outline_of(shape);
  ReportObstacle drawn{.name = name, .points = {}, .radius = outline.radius};
  for (const Eigen::Vector3d& point : outline.points) {
    drawn.points.push_back(in_space(Eigen::Vector3d(position + point)));
  }
  return drawn;
}

void add_elbows(const ParallelRobot& robot, Report& report) {
  const std::size_t samples = report.columns.at("pose_x").size();
  const auto legs = static_cast<std::size_t>(robot.legs());
  const auto dimension = static_cast<std::size_t>(robot.space_dimension());
  std::vector<std::vector<double>> columns(
      legs * dimension, std::vector<double>(samples, std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t k = 0; k < samples; ++k) {
    const Kinematics now = at_rest(robot, pose_at(robot.space(), report, k));
    if (!now.reachable) continue;
    for (std::size_t i = 0; i < legs * dimension; ++i) {
      columns[i][k] = now.legs[i / dimension].passive_joint[static_cast<Eigen::Index>(i % dimension)];
    }
  }
  for (std::size_t i = 0; i < legs * dimension; ++i) {
    report.columns["elbow_" + std::to_string(i / dimension + 1) + "_" + axes[i % dimension]] =
        std::move(columns[i]);
  }
}

}  // namespace flinch
