#include "plant/bench_plant.h"

#include <algorithm>
#include <cstddef>

namespace flinch {
namespace {

TouchTruth truth_of(const Touch& touch, int directions) {
  return {.body = touch.body,
          .obstacle = touch.obstacle,
          .held = touch.held,
          .point_in_base = touch.point.head(directions),
          .force_in_base = touch.force_on_robot.head(directions),
          .depth = touch.depth};
}

// Two bodies of one leg touch one obstacle.
bool a_leg_clamps(const BenchSnapshot& bench, const Mechanism& robot) {
  const auto& touches = bench.contacts.touches;
  const auto leg = [&](const Touch& touch) { return robot.body(BodyId::from_index(touch.body)).leg; };
  for (int i = 0; i < bench.contacts.touch_count; ++i) {
    const Touch& a = touches[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) {
      const Touch& b = touches[static_cast<std::size_t>(k)];
      if (a.obstacle == b.obstacle && a.body != b.body && leg(a) >= 0 && leg(a) == leg(b)) return true;
    }
  }
  return false;
}

}  // namespace

BenchPlant::BenchPlant(const BenchSettings& settings, Time tick)
    : dynamics_(BenchDynamics::make(settings)), tick_(tick) {
  require_adaptive_steps();
}

// ---------------------------------------------------------------- motion

void BenchPlant::move(const BenchState& motion, const DriveAction& acting, const AppliedWrench& wrench,
                      const BenchStep& step, BenchState& rates) const {
  dynamics_->rates(motion, acting, wrench.of(dynamics_->robot()), step, rates);
}

void BenchPlant::look(const BenchState& motion, const BenchStep& step, const DriveAction& acting,
                      const AppliedWrench& wrench, BenchSnapshot& out) const {
  dynamics_->snapshot(motion, acting, wrench.of(dynamics_->robot()), step, to_seconds(tick_), out);
}

void BenchPlant::look_ahead(Time now, const BenchState& motion, const BenchSnapshot& bench,
                            const BenchStep& before, BenchStep& after) const {
  dynamics_->next_step(motion, to_seconds(now), bench, before, after);
}

// ---------------------------------------------------------------- truth

void BenchPlant::tell_truth(Time now, const BenchSnapshot& bench, const DriveAction& acting,
                            PlantTruth& out) const {
  out = PlantTruth();
  out.acquired = now;
  out.valid = bench.reachable;
  out.pose = bench.pose;
  out.velocity = bench.velocity;
  out.drive_torque = out.valid ? bench.drive_torque : acting.torque;
  if (!out.valid) return;
  out.acceleration = bench.acceleration;
  out.wrench_in_base = bench.applied_wrench + bench.contacts.obstacle_wrench;
  out.kinetic_energy = bench.kinetic_energy;
  out.active = bench.joints.active;
  if (dynamics_->settings().elastic.any()) out.motors = bench.motors;
  out.passive = bench.joints.passive;
  out.coupling = bench.joints.coupling;
  out.loop_closure_error = bench.loop_closure_error;
}

void BenchPlant::tell_obstacles(Time now, const BenchSnapshot& bench, ObstacleTruth& out) const {
  out = ObstacleTruth();
  out.acquired = now;
  out.valid = bench.reachable;
  if (!out.valid) return;
  const Obstacles& scene = dynamics_->settings().obstacles;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    out.displacement_in_base[i] = bench.obstacles[i].position - scene[i]->form().position_in_base;
  }
}

void BenchPlant::tell_platform(const PlantTruth& robot, PlatformMotion& out) const {
  out.acquired = robot.acquired;
  out.status = robot.valid ? PlatformMotion::Status::valid : PlatformMotion::Status::no_data;
  out.pose = robot.pose;
  out.velocity = robot.velocity;
}

void BenchPlant::follow(Time now, const BenchSnapshot& bench, const ContactHistory& before,
                        ContactHistory& after) const {
  after = bench.reachable ? before.next(now, bench.near_pairs, bench.contacts) : before;
  after.now = now;
}

void BenchPlant::tell_contact(const BenchSnapshot& bench, const ContactHistory& history,
                              ContactTruth& out) const {
  const int directions = dynamics_->robot().space_dimension();
  out.clear(dynamics_->robot().dof(), directions);
  out.acquired = history.now;
  out.valid = bench.reachable;
  if (!out.valid) return;
  const ContactForces& contacts = bench.contacts;
  out.in_contact = history.in_contact;
  out.clamping = a_leg_clamps(bench, dynamics_->robot());
  for (int i = 0; i < contacts.touch_count; ++i) {
    out.add(truth_of(contacts.touches[static_cast<std::size_t>(i)], directions));
  }
  out.wrench_in_base = contacts.obstacle_wrench;
  out.pushed = !bench.applied_wrench.isZero(0.0);
  out.push_in_base = bench.applied_wrench;
  out.contacts = history.contacts;
  out.onset = history.onset;
  out.end = history.end;
  out.peak_force = history.peak_force;
  out.self_contact = contacts.self_contact;
  out.self_body = contacts.self_body;
  out.self_other = contacts.self_other;
  out.self_wrench_in_base = contacts.self_wrench;
}

}  // namespace flinch
