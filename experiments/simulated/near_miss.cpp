#include "experiments/simulated/near_miss.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "experiments/verdict/recorded_truth.h"
#include "plant/body_placement.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr std::size_t looked_at = 500;  // samples of a run
constexpr double nearer = 1e-3;         // than at the beginning, so that it counts as an approach [m]
constexpr double nowhere = std::numeric_limits<double>::infinity();

/// A body and an obstacle where they were nearest, nearer than at the beginning.
struct Miss {
  double gap = nowhere;  // [m]
  double time = 0.0;     // [s]
  int body = 0;
  std::size_t obstacle = 0;
  Eigen::Vector3d towards_body = Eigen::Vector3d::Zero();  // by which the obstacle would touch [m]
};

/// Whether a scenario that expects `contact` asks about this body.
bool is_meant(const Body& body, const std::string& contact) {
  const std::string leg = contact.substr(0, contact.find("_clamping"));
  return contact.empty() || body.name == contact ||
         (contact.ends_with("_clamping") && body.name.starts_with(leg + "_"));
}

std::vector<std::vector<Solid>> solids_of(const Mechanism& robot, const std::string& contact) {
  std::vector<std::vector<Solid>> all(static_cast<std::size_t>(robot.body_count()));
  for (int i = 0; i < robot.body_count(); ++i) {
    const Body& body = robot.body(BodyId::from_index(i));
    if (!is_meant(body, contact)) continue;
    for (const Shape& part : body.shapes) all[static_cast<std::size_t>(i)].emplace_back(part);
  }
  return all;
}

class Misses {
 public:
  Misses(const Scenario& scenario, const Recording& recording)
      : scenario_(scenario),
        robot_(*scenario.robot.robot),
        recording_(recording),
        truth_(recording, "truth"),
        bodies_(solids_of(robot_, scenario.expected.contact.value_or(""))) {
    for (const ScenarioObstacle& obstacle : scenario.obstacles) obstacles_.emplace_back(obstacle.shape);
    first_.assign(bodies_.size() * obstacles_.size(), nowhere);
    if (recording.find("obstacles") != nullptr) moved_.emplace(recording, "obstacles");
  }

  Miss nearest_of_all() {
    Miss found;
    const std::size_t stride = std::max<std::size_t>(1, recording_.samples() / looked_at);
    for (std::size_t sample = 0; sample < recording_.samples(); sample += stride) look(sample, found);
    return found;
  }

 private:
  void look(std::size_t sample, Miss& found) {
    Kinematics now;
    robot_.kinematics(truth_[sample].pose, PlatformVector::Zero(robot_.dof()), now);
    if (!now.reachable) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].empty()) continue;
      const Placement at = body_placement(robot_, now, BodyId::from_index(static_cast<int>(i)));
      for (std::size_t k = 0; k < obstacles_.size(); ++k) {
        const Placement there{.origin = scenario_.obstacles[k].position_in_base + displacement(sample, k)};
        SurfaceGap least{.gap = nowhere, .normal = Eigen::Vector3d::Zero(), .point = Eigen::Vector3d::Zero()};
        for (const Solid& part : bodies_[i]) {
          const SurfaceGap gap = nearest(part, at, obstacles_[k], there);
          if (gap.gap < least.gap) least = gap;
        }
        double& first = first_[i * obstacles_.size() + k];
        if (!(first < nowhere)) first = least.gap;
        if (least.gap > first - nearer || least.gap >= found.gap) continue;
        found = {least.gap, 1e-9 * static_cast<double>(recording_.time_ns[sample]), static_cast<int>(i), k,
                 -least.gap * least.normal};
      }
    }
  }

  Eigen::Vector3d displacement(std::size_t sample, std::size_t obstacle) const {
    if (!moved_) return Eigen::Vector3d::Zero();
    return (*moved_)[sample].displacement_in_base[obstacle];
  }

  const Scenario& scenario_;
  const ParallelRobot& robot_;
  const Recording& recording_;
  RecordedValues<RecordedTruth> truth_;
  std::optional<RecordedValues<RecordedObstacles>> moved_;
  std::vector<std::vector<Solid>> bodies_;  // none: not meant
  std::vector<Solid> obstacles_;
  std::vector<double> first_;  // gap of each pair at the beginning [m]
};

}  // namespace

std::string near_miss(const Scenario& scenario, const Recording& recording) {
  if (scenario.obstacles.empty() || recording.find("truth") == nullptr) return "";
  const Miss found = Misses(scenario, recording).nearest_of_all();
  if (!(found.gap < nowhere)) return "nothing that could be touched ever came nearer to an obstacle";
  const ScenarioObstacle& obstacle = scenario.obstacles[found.obstacle];
  const Eigen::Vector3d way = 1e3 * found.towards_body;
  const bool is_spatial = scenario.robot.robot->space_dimension() == 3;
  return fmt::format(
      "{} came nearest to {}, {:.0f} mm, at {:.3f} s; for a touch there, change {}.x_mm by {:.0f}, y_mm by "
      "{:.0f}{} and a little more",
      scenario.robot.robot->body(BodyId::from_index(found.body)).name, obstacle.name, 1e3 * found.gap,
      found.time, obstacle.key, way.x(), way.y(), is_spatial ? fmt::format(", z_mm by {:.0f}", way.z()) : "");
}

}  // namespace flinch
