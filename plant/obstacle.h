#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "plant/hunt_crossley.h"
#include "systems/robot/body.h"

namespace flinch {

class Findings;

/// Largest number of obstacles in a scene.
inline constexpr int max_obstacles = 8;

/// What all obstacles have. In the base frame; obstacles do not turn.
struct ObstacleForm {
  std::string name = "obstacle";
  /// About `position_in_base`. In a planar scene a sphere is an upright post.
  Shape shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.04};
  Eigen::Vector3d position_in_base{0.0, 0.0, 0.0};  ///< While nothing touches or moves it [m].
  ContactMaterial material{};
};

/// Displacement from the position at rest [m] and its time derivative [m/s].
struct ObstacleMotion {
  Eigen::Vector3d displacement{0.0, 0.0, 0.0};
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};
};

/// Two times between which a hand holds what it touches [s].
struct HoldingTimes {
  double begin = 0.0;
  double end = 0.0;
};

/// Something that the robot may run into, or that runs into the robot. It says how it moves; where it touches
/// and with what force is worked out elsewhere. Immutable: one object serves many threads.
class Obstacle {
 public:
  explicit Obstacle(ObstacleForm form) : form_(std::move(form)) {}
  virtual ~Obstacle() = default;

  const ObstacleForm& form() const noexcept { return form_; }
  /// All that is wrong with it, one sentence each that begins with `owner`.
  std::vector<std::string> problems(const std::string& owner) const;

  /// Whether its motion is a continuous state, integrated with the robot's. Otherwise `motion` says it.
  virtual bool moves_freely() const noexcept { return false; }
  /// Whether its motion or its acceleration depends on time.
  virtual bool follows_time() const noexcept { return false; }

  /// Whether it may be anywhere but at its position at rest.
  bool moves() const noexcept { return moves_freely() || follows_time(); }

  /// At the time `t` [s]; of one that moves freely, its motion at the start.
  virtual ObstacleMotion motion(double t) const noexcept;
  /// Of one that moves freely, under the `contact_force` of the robot on it [N]: [m/s^2].
  virtual Eigen::Vector3d acceleration(double t, const ObstacleMotion& now,
                                       const Eigen::Vector3d& contact_force) const noexcept;
  /// What it does to the ground or the arm that carries it [N].
  virtual Eigen::Vector3d force_on_mount(double t, const ObstacleMotion& now,
                                         const Eigen::Vector3d& contact_force) const noexcept;

  /// When it holds on to the robot; null for one that never does.
  virtual const HoldingTimes* holding() const noexcept { return nullptr; }
  /// Force of the grip on the robot, at a point held at first `offset` from the obstacle's position, that has
  /// moved by `stretch` [m] against it and moves with `rate` [m/s].
  virtual Eigen::Vector3d grip_force(const Eigen::Vector3d& stretch,
                                     const Eigen::Vector3d& rate) const noexcept;

 protected:
  virtual void find_problems(const std::string& owner, Findings& found) const;

 private:
  ObstacleForm form_;
};

/// One that stands still; only its surface gives way.
using FixedObstacle = Obstacle;

using Obstacles = std::vector<std::shared_ptr<const Obstacle>>;

}  // namespace flinch
