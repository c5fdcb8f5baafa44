#include "plant/obstacle_path.h"

#include <algorithm>
#include <cmath>

#include "systems/foundation/findings.h"

namespace flinch {

std::vector<std::string> ObstaclePath::problems(const std::string& owner) const {
  Findings found(owner);
  found.require(!points_.empty(), "path has no places; it needs at least one");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::string place = "path[" + std::to_string(i) + "]";
    if (!std::isfinite(points_[i].time) || !points_[i].displacement.allFinite()) {
      found.add(place + " must be finite");
    } else if (i > 0 && !(points_[i].time > points_[i - 1].time)) {
      found.add(place + ".time", points_[i].time, "s", "must be later than that of the place before");
    }
  }
  return found.take();
}

ObstacleMotion ObstaclePath::at(double t) const noexcept {
  if (points_.empty()) return {};
  const auto next = std::upper_bound(points_.begin(), points_.end(), t,
                                     [](double time, const PathPoint& point) { return time < point.time; });
  if (next == points_.begin()) return {points_.front().displacement, Eigen::Vector3d::Zero()};
  const PathPoint& from = *(next - 1);
  if (next == points_.end()) return {from.displacement, Eigen::Vector3d::Zero()};
  const double duration = next->time - from.time;
  const double s = (t - from.time) / duration;
  const Eigen::Vector3d way = next->displacement - from.displacement;
  const double share = s * s * s * (10.0 + s * (6.0 * s - 15.0));
  const double rate = 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration;
  return {from.displacement + share * way, rate * way};
}

void MovingObstacle::find_problems(const std::string& owner, Findings& found) const {
  found.add_all(path_.problems(owner));
}

}  // namespace flinch
