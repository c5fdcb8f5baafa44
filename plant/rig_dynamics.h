#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "plant/contact_candidates.h"
#include "plant/contact_forces.h"
#include "plant/drive_action.h"
#include "plant/rig_settings.h"
#include "systems/robot/kinematics.h"

namespace flinch {

/// The continuous state: the platform's coordinates xi in a chart and its velocity v; displacement and
/// velocity of each obstacle that moves freely; the time [s], where an obstacle or a rope follows it; the
/// twist of each elastic drive, by which its motor is ahead of its leg, and the rate of its motor.
using RigState = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4 * max_dof + 6 * max_obstacles + 1, 1>;

/// A chart of the configurations around that of a tick: the configuration is `pose` (+) (xi - `xi`). So xi
/// runs on from tick to tick without a jump, and the chart is always that around the present pose.
struct RigChart {
  Configuration pose;
  PlatformVector xi;
};

/// A point of a body that a hand holds.
struct HeldPoint {
  int body = -1;  ///< -1: none
  Eigen::Vector3d point_in_body{0.0, 0.0, 0.0};
  Eigen::Vector3d offset{0.0, 0.0, 0.0};  ///< Of that point from the hand's position when it was seized.
};

/// What stays the same from one tick to the next.
struct RigStep {
  RigChart chart;
  ContactSearch search;
  std::array<HeldPoint, max_obstacles> held;
  /// Positions of the motors at which their closed brakes bear nothing [rad or m]; empty: where they are.
  JointVector braked_at;
  /// Where their friction that sticks bears nothing, likewise.
  JointVector stuck_at;
  /// Its brakes hold the robot, and nothing moves it: it stays at rest while both hold.
  bool at_rest = false;
};

/// Everything about the rig at one instant. Wrenches and forces in the base frame.
struct RigSnapshot {
  /// Unless all legs reach the pose, nothing below pose and velocity means anything.
  bool reachable = false;
  Configuration pose;
  PlatformVector velocity;
  JointAngles joints;
  JointVector motors;               ///< Their positions; those of the legs unless drives are elastic.
  double loop_closure_error = 0.0;  ///< As in PlantTruth [m].
  double kinetic_energy = 0.0;      ///< [J]
  double elastic_energy = 0.0;      ///< Of twisted drives [J].
  JointVector drive_torque;         ///< That acts, without the brakes' [Nm or N].
  JointVector torque_on_legs;       ///< With the brakes' and that of friction that sticks [Nm or N].
  JointVector braked_at;            ///< As in RigStep, from now on.
  JointVector stuck_at;             ///< Likewise.
  bool at_rest = false;             ///< Likewise.
  PlatformVector acceleration;
  PlatformVector applied_wrench;
  ContactForces contacts;
  ContactSearch search;  ///< For those that can touch until the next tick.
  NearPairs near_pairs;
  int obstacle_count = 0;
  PlacedObstacles obstacles;                                  ///< The first `obstacle_count` are used.
  std::array<Eigen::Vector3d, max_obstacles> force_on_mount;  ///< What each obstacle does to what carries it.
};

/// The rig as an ordinary differential equation in platform coordinates:
/// It is regular at type-II singularities. Where a leg would have to stretch beyond its reach the rig
/// stands still and its motion is not reachable. Robot and obstacles are one equation, since their contact
/// forces depend on both. Immutable: one object serves many threads.
class RigDynamics {
 public:
  /// Of any mechanism; a planar 3-RRR among round obstacles is computed in closed form. Throws SetupError
  /// with all problems.
  static std::unique_ptr<const RigDynamics> make(const RigSettings& settings);
  virtual ~RigDynamics() = default;

  const RigSettings& settings() const noexcept { return settings_; }
  const Mechanism& robot() const noexcept { return *settings_.robot; }
  int obstacle_count() const noexcept { return static_cast<int>(settings_.obstacles.size()); }

  RigState initial_state() const;
  /// The chart around the start, all pairs, nothing held.
  RigStep initial_step() const;

  /// The time derivative of `state`, with the forces of the contacts in `step`.
  virtual void rates(const RigState& state, const DriveAction& drives, const PlatformVector& applied_wrench,
                     const RigStep& step, RigState& rates) const noexcept = 0;

  /// The same with all contacts, all that lies behind it, and what can touch within `duration` [s] from now.
  virtual void snapshot(const RigState& state, const DriveAction& drives,
                        const PlatformVector& applied_wrench, const RigStep& step, double duration,
                        RigSnapshot& out) const noexcept = 0;

  /// The step that begins at `state` and time `t` [s], of which `snapshot` was taken in the step `before`.
  virtual void next_step(const RigState& state, double t, const RigSnapshot& snapshot, const RigStep& before,
                         RigStep& out) const noexcept = 0;

 protected:
  explicit RigDynamics(const RigSettings& settings);

  const ElasticDrives& elastic() const noexcept { return elastic_; }

  // Places in the state.
  int twist_at() const noexcept { return twist_at_; }
  int motor_rate_at() const noexcept { return twist_at_ + robot().drives(); }
  int dof() const noexcept { return dof_; }
  ObstacleMotion motion(std::size_t obstacle, const RigState& state) const noexcept;
  double time(const RigState& state) const noexcept { return time_at_ < 0 ? 0.0 : state[time_at_]; }
  void place_obstacles(const RigState& state, PlacedObstacles& out) const noexcept;
  void add_obstacle_rates(const RigState& state, const ContactForces& contacts,
                          RigState& rates) const noexcept;
  /// What a closed brake does to its drive at this rate, when it bears nothing at `braked_at`.
  double brake_effort(int drive, double rate, double position, double braked_at) const noexcept;
  /// Where a closed brake bears nothing from now on: it has slid if that is too far away.
  double brake_slides_to(int drive, double position, double braked_at) const noexcept;
  /// Whether the friction of drives sticks.
  bool sticks() const noexcept { return settings_.sticking.stiffness.size() > 0; }
  const DryFriction& dry_friction(int drive) const noexcept {
    return friction_[static_cast<std::size_t>(drive)];
  }
  /// What friction that sticks, and bears nothing at `stuck_at`, does to its drive beyond that of the robot.
  double sticking_effort(int drive, double rate, double position, double stuck_at) const noexcept;
  /// Where it bears nothing from now on.
  double friction_slides_to(int drive, double position, double stuck_at) const noexcept;

 private:
  /// Where friction bears nothing from now on: it has slid if `held_at` is too far away for this `give`.
  double slides_to(int drive, double position, double held_at, double give) const noexcept;
  /// From one position of a drive to another; angles by the shorter way.
  double way(int drive, double from, double to) const noexcept;

  /// Friction of a closed brake as the rig has it, of a drive.
  struct ClosedBrake {
    double effort, velocity, give;
  };
  std::vector<ClosedBrake> closed_brakes() const;

  RigSettings settings_;
  ElasticDrives elastic_;
  std::vector<ClosedBrake> brakes_;    ///< of each drive
  std::vector<DryFriction> friction_;  ///< of each drive
  int dof_;
  std::array<int, max_obstacles> obstacle_at_{};  ///< -1: it does not move freely
  int time_at_ = -1;
  int twist_at_ = -1;
  int size_ = 0;
};

}  // namespace flinch
