#include "plant/rig_plant.h"

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
bool a_leg_clamps(const RigSnapshot& rig, const Mechanism& robot) {
  const auto& touches = rig.contacts.touches;
  const auto leg = [&](const Touch& touch) { return robot.body(BodyId::from_index(touch.body)).leg; };
  for (int i = 0; i < rig.contacts.touch_count; ++i) {
    const Touch& a = touches[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) {
      const Touch& b = touches[static_cast<std::size_t>(k)];
      if (a.obstacle == b.obstacle && a.body != b.body && leg(a) >= 0 && leg(a) == leg(b)) return true;
    }
  }
  return false;
}

}  // namespace

RigPlant::RigPlant(const RigSettings& settings, Time tick)
    : dynamics_(RigDynamics::make(settings)), tick_(tick) {
  require_adaptive_steps();
}

// ---------------------------------------------------------------- motion

void RigPlant::move(const RigState& motion, const DriveAction& acting, const AppliedWrench& wrench,
                    const RigStep& step, RigState& rates) const {
  dynamics_->rates(motion, acting, wrench.of(dynamics_->robot()), step, rates);
}

void RigPlant::look(const RigState& motion, const RigStep& step, const DriveAction& acting,
                    const AppliedWrench& wrench, RigSnapshot& out) const {
  dynamics_->snapshot(motion, acting, wrench.of(dynamics_->robot()), step, to_seconds(tick_), out);
}

void RigPlant::look_ahead(Time now, const RigState& motion, const RigSnapshot& rig, const RigStep& before,
                          RigStep& after) const {
  dynamics_->next_step(motion, to_seconds(now), rig, before, after);
}

// ---------------------------------------------------------------- truth

void RigPlant::tell_truth(Time now, const RigSnapshot& rig, const DriveAction& acting,
                          PlantTruth& out) const {
  out = PlantTruth();
  out.acquired = now;
  out.valid = rig.reachable;
  out.pose = rig.pose;
  out.velocity = rig.velocity;
  out.drive_torque = out.valid ? rig.drive_torque : acting.torque;
  if (!out.valid) return;
  out.acceleration = rig.acceleration;
  out.wrench_in_base = rig.applied_wrench + rig.contacts.obstacle_wrench;
  out.kinetic_energy = rig.kinetic_energy;
  out.active = rig.joints.active;
  if (dynamics_->settings().elastic.any()) out.motors = rig.motors;
  out.passive = rig.joints.passive;
  out.coupling = rig.joints.coupling;
  out.loop_closure_error = rig.loop_closure_error;
}

void RigPlant::tell_obstacles(Time now, const RigSnapshot& rig, ObstacleTruth& out) const {
  out = ObstacleTruth();
  out.acquired = now;
  out.valid = rig.reachable;
  if (!out.valid) return;
  const Obstacles& scene = dynamics_->settings().obstacles;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    out.displacement_in_base[i] = rig.obstacles[i].position - scene[i]->form().position_in_base;
  }
}

void RigPlant::tell_platform(const PlantTruth& robot, PlatformMotion& out) const {
  out.acquired = robot.acquired;
  out.status = robot.valid ? PlatformMotion::Status::valid : PlatformMotion::Status::no_data;
  out.pose = robot.pose;
  out.velocity = robot.velocity;
}

void RigPlant::follow(Time now, const RigSnapshot& rig, const ContactHistory& before,
                      ContactHistory& after) const {
  after = rig.reachable ? before.next(now, rig.near_pairs, rig.contacts) : before;
  after.now = now;
}

void RigPlant::tell_contact(const RigSnapshot& rig, const ContactHistory& history, ContactTruth& out) const {
  const int directions = dynamics_->robot().space_dimension();
  out.clear(dynamics_->robot().dof(), directions);
  out.acquired = history.now;
  out.valid = rig.reachable;
  if (!out.valid) return;
  const ContactForces& contacts = rig.contacts;
  out.in_contact = history.in_contact;
  out.clamping = a_leg_clamps(rig, dynamics_->robot());
  for (int i = 0; i < contacts.touch_count; ++i) {
    out.add(truth_of(contacts.touches[static_cast<std::size_t>(i)], directions));
  }
  out.wrench_in_base = contacts.obstacle_wrench;
  out.pushed = !rig.applied_wrench.isZero(0.0);
  out.push_in_base = rig.applied_wrench;
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
