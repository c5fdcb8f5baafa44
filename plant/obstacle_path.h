#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plant/obstacle.h"

namespace flinch {

/// A place on a path, and when to be there.
struct PathPoint {
  double time = 0.0;                            ///< [s]
  Eigen::Vector3d displacement{0.0, 0.0, 0.0};  ///< From the position at rest [m].
};

/// A motion from place to place, at rest at each: 10 s^3 - 15 s^4 + 6 s^5 of the way after the share s of the
/// time. Before the first and after the last place it stands still.
class ObstaclePath {
 public:
  ObstaclePath() = default;
  explicit ObstaclePath(std::vector<PathPoint> points) : points_(std::move(points)) {}

  const std::vector<PathPoint>& points() const noexcept { return points_; }
  /// All that is wrong with it: times must rise, all must be finite.
  std::vector<std::string> problems(const std::string& owner) const;

  ObstacleMotion at(double t) const noexcept;

 private:
  std::vector<PathPoint> points_;
};

/// An obstacle that follows a path whatever it runs into.
class MovingObstacle final : public Obstacle {
 public:
  MovingObstacle(ObstacleForm form, ObstaclePath path) : Obstacle(std::move(form)), path_(std::move(path)) {}

  const ObstaclePath& path() const noexcept { return path_; }

  bool follows_time() const noexcept override { return true; }
  ObstacleMotion motion(double t) const noexcept override { return path_.at(t); }

 protected:
  void find_problems(const std::string& owner, Findings& found) const override;

 private:
  ObstaclePath path_;
};

}  // namespace flinch
