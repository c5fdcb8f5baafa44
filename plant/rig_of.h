#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "plant/hunt_crossley.h"
#include "plant/rig_dynamics.h"
#include "systems/robot/decompositions.h"

namespace flinch {

/// The rig with a robot whose motion and outlines `Robot` computes: PlanarRig or GeneralRig. What a
/// Robot must offer is what those two have in common.
template <class Robot>
class RigOf final : public RigDynamics {
 public:
  using Instant = typename Robot::Instant;

  explicit RigOf(const RigSettings& settings) : RigDynamics(settings), robot_(settings) {
    for (const auto& obstacle : settings.obstacles) laws_.emplace_back(obstacle->form().material);
    if (settings.link_material) link_law_ = HuntCrossley(*settings.link_material);
  }

  const Robot& moving_robot() const noexcept { return robot_; }

  /// Adds the forces of the contacts in `candidates` and of the points that are held in `step`.
  void find_forces(const Instant& now, const PlacedObstacles& obstacles, const RigStep& step,
                   const ContactCandidates& candidates, ContactForces& out) const noexcept;

  void rates(const RigState& state, const DriveAction& drives, const PlatformVector& applied_wrench,
             const RigStep& step, RigState& rates) const noexcept override;
  void snapshot(const RigState& state, const DriveAction& drives, const PlatformVector& applied_wrench,
                const RigStep& step, double duration, RigSnapshot& out) const noexcept override;
  void next_step(const RigState& state, double t, const RigSnapshot& snapshot, const RigStep& before,
                 RigStep& out) const noexcept override;

 private:
  struct MotorMotion {
    double position, rate;
  };
  struct Accelerations {
    PlatformVector platform;
    JointVector motors;   ///< Of elastic drives; empty: they move with their legs.
    JointVector on_legs;  ///< Torques that drives, brakes and friction that sticks put on the legs.
  };

  void touch(const Instant& now, int body, int obstacle, const PlacedObstacle& placed, const SurfaceGap& gap,
             ContactForces& out) const noexcept;
  void meet(const Instant& now, int body, int other, const SurfaceGap& gap,
            ContactForces& out) const noexcept;
  void hold(const Instant& now, int obstacle, const PlacedObstacle& placed, const HeldPoint& held,
            ContactForces& out) const noexcept;
  HeldPoint next_held(std::size_t obstacle, const RigState& state, double t, const RigSnapshot& snapshot,
                      const RigStep& before) const noexcept;
  PlatformVector pulled(const Instant& now, const RigState& state) const noexcept;
  bool rests(const RigSnapshot& now, const DriveAction& drives, const RigStep& step,
             double duration) const noexcept;
  bool motors_rest(const RigState& state, const Accelerations& now, double duration) const noexcept;
  JointVector drive_torque(const Instant& now, const RigState& state,
                           const DriveAction& drives) const noexcept;
  void describe_motors(const Instant& now, const RigState& state, RigSnapshot& out) const noexcept;
  JointVector braked_at(const JointVector& motors, const DriveAction& drives,
                        const RigStep& step) const noexcept;
  JointVector stuck_at(const JointVector& motors, const RigStep& step) const noexcept;
  MotorMotion motor(const Instant& now, const RigState& state, int drive) const noexcept;
  double friction_and_brake(const Instant& now, const RigState& state, int drive, const DriveAction& drives,
                            const RigStep& step) const noexcept;
  Accelerations accelerations(const Instant& now, const RigState& state, JointVector torque,
                              const DriveAction& drives, const RigStep& step,
                              const PlatformVector& wrench) const noexcept;
  PlatformVector without_rotors(const Instant& now, const JointVector& torque,
                                const PlatformVector& wrench) const noexcept;

  Robot robot_;
  std::vector<HuntCrossley> laws_;  ///< one an obstacle
  HuntCrossley link_law_;
};

namespace internal {

/// Force on a body whose surface approaches the other's with `velocity`.
inline Eigen::Vector3d contact_force(const HuntCrossley& law, const SurfaceGap& gap,
                                     const Eigen::Vector3d& velocity) {
  const double approach = velocity.dot(gap.normal);
  const double push = law.normal_force(-gap.gap, approach);
  return -push * gap.normal + law.friction_force(push, velocity - approach * gap.normal);
}

/// Share of its friction that the brake of a drive puts on it.
inline double held_share(const DriveAction& drives, int drive) {
  return drives.hold.size() > 0 ? drives.hold[drive] : (drives.braked ? 1.0 : 0.0);
}

/// Slower than this the robot rests [m/s, rad/s]: in a tick it moves by less than the integrator may err.
inline constexpr double resting_velocity = 1e-8;

/// Whether all brakes are closed, and neither a torque nor a wrench acts against them.
inline bool only_brakes_act(const DriveAction& drives, const PlatformVector& applied_wrench) {
  return drives.braked && drives.hold.size() == 0 && drives.torque.isZero(0.0) && applied_wrench.isZero(0.0);
}

/// Whether anything can touch the robot, or holds it, in a step.
inline bool can_touch(const ContactCandidates& candidates, const RigStep& step, int obstacles) {
  if (!candidates.none()) return true;
  return std::any_of(step.held.begin(), step.held.begin() + obstacles,
                     [](const HeldPoint& held) { return held.body >= 0; });
}

inline void add(const Touch& touch, ContactForces& out) {
  if (out.touch_count < max_touches) out.touches[static_cast<std::size_t>(out.touch_count++)] = touch;
}

}  // namespace internal

// ---------------------------------------------------------------- forces

template <class Robot>
void RigOf<Robot>::find_forces(const Instant& now, const PlacedObstacles& obstacles, const RigStep& step,
                               const ContactCandidates& candidates, ContactForces& out) const noexcept {
  robot_.for_each_gap(
      now, obstacles, candidates,
      [&](int body, int obstacle, const SurfaceGap& gap) {
        if (gap.gap < 0.0)
          touch(now, body, obstacle, obstacles[static_cast<std::size_t>(obstacle)], gap, out);
      },
      [&](int body, int other, const SurfaceGap& gap) {
        if (gap.gap < 0.0) meet(now, body, other, gap, out);
      });
  for (int i = 0; i < obstacle_count(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (step.held[index].body >= 0) hold(now, i, obstacles[index], step.held[index], out);
  }
}

template <class Robot>
void RigOf<Robot>::touch(const Instant& now, int body, int obstacle, const PlacedObstacle& placed,
                         const SurfaceGap& gap, ContactForces& out) const noexcept {
  const auto index = static_cast<std::size_t>(obstacle);
  const Eigen::Vector3d velocity = robot_.point_velocity(now, body, gap.point) - placed.velocity;
  const Eigen::Vector3d force = internal::contact_force(laws_[index], gap, velocity);
  out.obstacle_wrench += robot_.wrench(now, body, gap.point, force);
  out.on_obstacle[index] -= force;
  internal::add({body, obstacle, gap.point, force, -gap.gap, false}, out);
}

template <class Robot>
void RigOf<Robot>::meet(const Instant& now, int body, int other, const SurfaceGap& gap,
                        ContactForces& out) const noexcept {
  const Eigen::Vector3d velocity =
      robot_.point_velocity(now, body, gap.point) - robot_.point_velocity(now, other, gap.point);
  const Eigen::Vector3d force = internal::contact_force(link_law_, gap, velocity);
  out.self_wrench +=
      robot_.wrench(now, body, gap.point, force) + robot_.wrench(now, other, gap.point, -force);
  if (!out.self_contact) out.self_body = body, out.self_other = other;
  out.self_contact = true;
}

template <class Robot>
void RigOf<Robot>::hold(const Instant& now, int obstacle, const PlacedObstacle& placed, const HeldPoint& held,
                        ContactForces& out) const noexcept {
  const auto index = static_cast<std::size_t>(obstacle);
  const Eigen::Vector3d point = robot_.point_in_base(now, held.body, held.point_in_body);
  const Eigen::Vector3d stretch = point - (placed.position + held.offset);
  const Eigen::Vector3d rate = robot_.point_velocity(now, held.body, point) - placed.velocity;
  const Eigen::Vector3d force = settings().obstacles[index]->grip_force(stretch, rate);
  out.obstacle_wrench += robot_.wrench(now, held.body, point, force);
  out.on_obstacle[index] -= force;
  internal::add({held.body, obstacle, point, force, 0.0, true}, out);
}

/// What all ropes do to the platform.
template <class Robot>
PlatformVector RigOf<Robot>::pulled(const Instant& now, const RigState& state) const noexcept {
  PlatformVector wrench = PlatformVector::Zero(dof());
  for (const RopePull& pull : settings().pulls) {
    const Eigen::Vector3d force = pull.at(time(state));
    if (force.isZero(0.0)) continue;
    const Eigen::Vector3d point = robot_.point_in_base(now, pull.body, pull.point_in_body);
    wrench += robot_.wrench(now, pull.body, point, force);
  }
  return wrench;
}

template <class Robot>
auto RigOf<Robot>::motor(const Instant& now, const RigState& state, int drive) const noexcept -> MotorMotion {
  const double of_leg = robot_.drive_position(now, drive);
  if (!elastic().any()) return {of_leg, robot_.drive_rate(now, drive)};
  return {of_leg + state[twist_at() + drive], state[motor_rate_at() + drive]};
}

template <class Robot>
JointVector RigOf<Robot>::drive_torque(const Instant& now, const RigState& state,
                                       const DriveAction& drives) const noexcept {
  JointVector torque = drives.torque;
  if (torque.size() != robot().drives()) torque.setZero(robot().drives());
  for (int i = 0; i < static_cast<int>(settings().torque_ripple.size()); ++i) {
    torque[i] = elastic().any() ? settings().torque_ripple[static_cast<std::size_t>(i)].at(
                                      motor(now, state, i).position, torque[i])
                                : robot_.torque_ripple(now, i, torque[i]);
  }
  return torque;
}

/// Where they are, and the energy that they have in the place of what the robot says of them.
template <class Robot>
void RigOf<Robot>::describe_motors(const Instant& now, const RigState& state,
                                   RigSnapshot& out) const noexcept {
  for (int i = 0; i < robot().drives(); ++i) {
    const double leg_rate = robot_.drive_rate(now, i);
    const MotorMotion of_motor = motor(now, state, i);
    out.motors[i] = of_motor.position;
    out.kinetic_energy +=
        0.5 * elastic().rotor_inertia(i) * (of_motor.rate * of_motor.rate - leg_rate * leg_rate);
    out.elastic_energy += elastic().energy(i, state[twist_at() + i]);
  }
}

/// What closed brakes and friction that sticks do to a motor, beyond the robot's own friction.
template <class Robot>
double RigOf<Robot>::friction_and_brake(const Instant& now, const RigState& state, int drive,
                                        const DriveAction& drives, const RigStep& step) const noexcept {
  const double share = internal::held_share(drives, drive);
  if (!sticks() && !(share > 0.0)) return 0.0;  // the position of a drive is dear
  const MotorMotion motor = this->motor(now, state, drive);
  double torque = 0.0;
  if (sticks()) {
    const double stuck_at = step.stuck_at.size() > 0 ? step.stuck_at[drive] : motor.position;
    torque += sticking_effort(drive, motor.rate, motor.position, stuck_at);
  }
  if (!(share > 0.0)) return torque;
  const double braked_at = step.braked_at.size() > 0 ? step.braked_at[drive] : motor.position;
  return torque + share * brake_effort(drive, motor.rate, motor.position, braked_at);
}

/// Where drives are elastic, their dry friction is that of the motor.
template <class Robot>
auto RigOf<Robot>::accelerations(const Instant& now, const RigState& state, JointVector torque,
                                 const DriveAction& drives, const RigStep& step,
                                 const PlatformVector& wrench) const noexcept -> Accelerations {
  JointVector motors;
  if (elastic().any()) motors.resize(robot().drives());
  for (int i = 0; i < robot().drives(); ++i) {
    torque[i] += friction_and_brake(now, state, i, drives, step);
    if (!elastic().any()) continue;
    const double leg_rate = robot_.drive_rate(now, i), motor_rate = state[motor_rate_at() + i];
    const double passed_on = elastic().effort(i, state[twist_at() + i], motor_rate - leg_rate);
    motors[i] = (torque[i] - dry_friction(i).at(motor_rate) - passed_on) / elastic().rotor_inertia(i);
    torque[i] = passed_on + dry_friction(i).at(leg_rate);
  }
  if (!elastic().any()) return {robot_.acceleration(now, torque, wrench), motors, torque};
  return {without_rotors(now, torque, wrench), motors, torque};
}

/// The robot's acceleration, but for the rotors that its equations count with the legs: they would need the
/// torques J q'' to move. With S = A M^-1 A^T and q0'' as if they were there: q'' = (1 - S J)^-1 q0''.
template <class Robot>
PlatformVector RigOf<Robot>::without_rotors(const Instant& now, const JointVector& torque,
                                            const PlatformVector& wrench) const noexcept {
  const int n = robot().drives();
  const PlatformVector with = robot_.acceleration(now, torque, wrench);
  const JointVector q_with = robot_.drive_accelerations(now, with);
  PlatformMatrix by_torque(dof(), n);
  PlatformMatrix coupled = PlatformMatrix::Identity(n, n);
  for (int k = 0; k < n; ++k) {
    JointVector more = torque;
    more[k] += elastic().rotor_inertia(k);
    by_torque.col(k) = robot_.acceleration(now, more, wrench) - with;
    coupled.col(k) -= robot_.drive_accelerations(now, with + by_torque.col(k)) - q_with;
  }
  return with + by_torque * coupled.partialPivLu().solve(q_with);
}

template <class Robot>
JointVector RigOf<Robot>::braked_at(const JointVector& motors, const DriveAction& drives,
                                    const RigStep& step) const noexcept {
  JointVector next = motors;
  if (step.braked_at.size() == 0) return next;
  for (int i = 0; i < robot().drives(); ++i) {
    if (internal::held_share(drives, i) > 0.0) next[i] = brake_slides_to(i, next[i], step.braked_at[i]);
  }
  return next;
}

template <class Robot>
JointVector RigOf<Robot>::stuck_at(const JointVector& motors, const RigStep& step) const noexcept {
  JointVector next = motors;
  if (!sticks() || step.stuck_at.size() == 0) return next;
  for (int i = 0; i < robot().drives(); ++i) next[i] = friction_slides_to(i, next[i], step.stuck_at[i]);
  return next;
}

/// Whether the robot neither moves nor will within `duration`, as long as nothing but its brakes acts on it.
template <class Robot>
bool RigOf<Robot>::rests(const RigSnapshot& now, const DriveAction& drives, const RigStep& step,
                         double duration) const noexcept {
  if (!internal::only_brakes_act(drives, now.applied_wrench) || !settings().pulls.empty()) return false;
  if (internal::can_touch(now.search.candidates, step, obstacle_count())) return false;
  const PlatformVector soon = now.velocity.cwiseAbs() + duration * now.acceleration.cwiseAbs();
  return (soon.array() < internal::resting_velocity).all();
}

template <class Robot>
bool RigOf<Robot>::motors_rest(const RigState& state, const Accelerations& now,
                               double duration) const noexcept {
  if (!elastic().any()) return true;
  const auto rates = state.segment(motor_rate_at(), robot().drives()).array();
  return (rates.abs() + duration * now.motors.array().abs() < internal::resting_velocity).all();
}

// ---------------------------------------------------------------- motion

template <class Robot>
void RigOf<Robot>::rates(const RigState& state, const DriveAction& drives,
                         const PlatformVector& applied_wrench, const RigStep& step,
                         RigState& rates) const noexcept {
  rates.setZero(state.size());
  ContactForces contacts(dof());
  if (step.at_rest && internal::only_brakes_act(drives, applied_wrench))
    return add_obstacle_rates(state, contacts, rates);
  Instant now;
  if (!robot_.at(state, step.chart, now)) return;
  PlatformVector wrench = applied_wrench;
  if (!settings().pulls.empty()) wrench += pulled(now, state);
  if (internal::can_touch(step.search.candidates, step, obstacle_count())) {
    PlacedObstacles obstacles;
    place_obstacles(state, obstacles);
    find_forces(now, obstacles, step, step.search.candidates, contacts);
    wrench += contacts.obstacle_wrench + contacts.self_wrench;
  }
  add_obstacle_rates(state, contacts, rates);
  robot_.coordinate_rates(state, step.chart, rates);
  const Accelerations moving =
      accelerations(now, state, drive_torque(now, state, drives), drives, step, wrench);
  rates.segment(dof(), dof()) = moving.platform;
  for (int i = 0; i < moving.motors.size(); ++i) {
    rates[twist_at() + i] = state[motor_rate_at() + i] - robot_.drive_rate(now, i);
    rates[motor_rate_at() + i] = moving.motors[i];
  }
}

template <class Robot>
void RigOf<Robot>::snapshot(const RigState& state, const DriveAction& drives,
                            const PlatformVector& applied_wrench, const RigStep& step, double duration,
                            RigSnapshot& out) const noexcept {
  Instant now;
  out.reachable = robot_.at(state, step.chart, now);
  out.pose = robot_.pose(state, step.chart);
  out.velocity = state.segment(dof(), dof());
  out.applied_wrench = applied_wrench;
  out.obstacle_count = obstacle_count();
  out.contacts.clear(dof());
  out.near_pairs.count = 0;
  out.at_rest = false;
  out.elastic_energy = 0.0;
  if (!out.reachable) return;
  out.applied_wrench += pulled(now, state);
  robot_.describe(now, out);
  place_obstacles(state, out.obstacles);
  out.search = robot_.find_candidates(now, out.obstacles, duration, step.search.clearance);
  find_forces(now, out.obstacles, step, out.search.candidates, out.contacts);
  out.drive_torque = drive_torque(now, state, drives);
  out.motors = out.joints.active;
  if (elastic().any()) describe_motors(now, state, out);
  out.braked_at = braked_at(out.motors, drives, step);
  out.stuck_at = stuck_at(out.motors, step);
  const Accelerations moving =
      accelerations(now, state, out.drive_torque, drives, step,
                    out.applied_wrench + out.contacts.obstacle_wrench + out.contacts.self_wrench);
  out.acceleration = moving.platform;
  out.torque_on_legs = moving.on_legs;
  out.at_rest = rests(out, drives, step, duration) && motors_rest(state, moving, duration);
  robot_.find_near_pairs(now, out.obstacles, out.near_pairs);
  for (std::size_t i = 0; i < settings().obstacles.size(); ++i) {
    out.force_on_mount[i] =
        settings().obstacles[i]->force_on_mount(time(state), motion(i, state), out.contacts.on_obstacle[i]);
  }
}

// ---------------------------------------------------------------- from tick to tick

template <class Robot>
void RigOf<Robot>::next_step(const RigState& state, double t, const RigSnapshot& snapshot,
                             const RigStep& before, RigStep& out) const noexcept {
  if (!snapshot.reachable) {
    out = before;
    return;
  }
  out.chart.pose = snapshot.pose;
  out.chart.xi = state.head(dof());
  out.search = snapshot.search;
  out.braked_at = snapshot.braked_at;
  out.stuck_at = snapshot.stuck_at;
  out.at_rest = snapshot.at_rest;
  for (std::size_t i = 0; i < settings().obstacles.size(); ++i) {
    out.held[i] = next_held(i, state, t, snapshot, before);
  }
}

template <class Robot>
HeldPoint RigOf<Robot>::next_held(std::size_t obstacle, const RigState& state, double t,
                                  const RigSnapshot& snapshot, const RigStep& before) const noexcept {
  const HoldingTimes* holding = settings().obstacles[obstacle]->holding();
  if (holding == nullptr || t < holding->begin || t >= holding->end) return {};
  if (before.held[obstacle].body >= 0) return before.held[obstacle];
  const NearPair* touching = snapshot.near_pairs.nearest_of(static_cast<int>(obstacle));
  Instant now;
  if (touching == nullptr || touching->gap >= 0.0 || !robot_.at(state, before.chart, now)) return {};
  const SurfaceGap gap = robot_.gap(now, touching->body, touching->obstacle, snapshot.obstacles);
  return {touching->body, robot_.point_in_body(now, touching->body, gap.point),
          gap.point - snapshot.obstacles[obstacle].position};
}

}  // namespace flinch
