#include "plant/bench_plant.h"

#include <cstddef>
#include <tuple>
#include <utility>

namespace flinch {
namespace {

TouchTruth truth_of(const Touch& touch) {
  return {touch.body.index(), touch.point, touch.force_on_robot, touch.depth};
}

double strength(const TouchTruth& touch) { return touch.body < 0 ? -1.0 : touch.force_in_base.norm(); }

// The two strongest contacts, the stronger one first.
std::pair<TouchTruth, TouchTruth> strongest_two(const ContactForces& contacts) {
  TouchTruth first;
  TouchTruth second;
  for (int i = 0; i < contacts.touch_count; ++i) {
    TouchTruth touch = truth_of(contacts.touches[static_cast<std::size_t>(i)]);
    if (strength(touch) > strength(first)) std::swap(touch, first);
    if (strength(touch) > strength(second)) second = touch;
  }
  return {first, second};
}

bool both_links_of_a_leg_touch(const ContactForces& contacts) {
  for (int i = 0; i < contacts.touch_count; ++i) {
    for (int k = 0; k < i; ++k) {
      const BodyId a = contacts.touches[static_cast<std::size_t>(i)].body;
      const BodyId b = contacts.touches[static_cast<std::size_t>(k)].body;
      if (!a.is_platform() && a.leg() == b.leg()) return true;
    }
  }
  return false;
}

}  // namespace

BenchPlant::BenchPlant(const BenchSettings& settings, Time tick) : dynamics_(settings), tick_(tick) {}

// ---------------------------------------------------------------- motion

void BenchPlant::move(const BenchState& motion, const DriveAction& acting, const AppliedWrench& wrench,
                      const ContactCandidates& candidates, BenchState& rates) const {
  dynamics_.rates(motion, acting, wrench.wrench_in_base, candidates, rates);
}

ContactCandidates BenchPlant::look_ahead(const BenchState& motion) const {
  return dynamics_.candidates(motion, to_seconds(tick_));
}

void BenchPlant::look(const BenchState& motion, const DriveAction& acting, const AppliedWrench& wrench,
                      BenchSnapshot& out) const {
  dynamics_.snapshot(motion, acting, wrench.wrench_in_base, out);
}

// ---------------------------------------------------------------- truth

void BenchPlant::tell_truth(Time now, const BenchSnapshot& bench, const DriveAction& acting,
                            PlantTruth& out) const {
  const PlanarRrr& robot = dynamics_.robot();
  const PlanarMotion& motion = bench.motion;
  out = PlantTruth();
  out.acquired = now;
  out.valid = motion.reachable;
  out.pose = motion.pose;
  out.velocity = motion.velocity;
  out.drive_torque = acting.torque;
  if (!out.valid) return;
  out.acceleration = bench.acceleration;
  out.wrench_in_base = bench.applied_wrench + bench.contacts.pylon_wrench;
  out.kinetic_energy = robot.kinetic_energy(motion);
  const JointAngles joints = robot.inverse_kinematics(out.pose, robot.home_working_mode()).joints;
  out.active = joints.active;
  out.passive = joints.passive;
  out.coupling = joints.coupling;
  out.loop_closure_error = robot.chain_closure_error(joints.active, joints.passive, out.pose);
}

void BenchPlant::tell_platform(const PlantTruth& robot, PlatformMotion& out) const {
  out.acquired = robot.acquired;
  out.status = robot.valid ? PlatformMotion::Status::valid : PlatformMotion::Status::no_data;
  out.pose = robot.pose;
  out.velocity = robot.velocity;
}

void BenchPlant::follow(Time now, const BenchSnapshot& bench, const ContactHistory& before,
                        ContactHistory& after) const {
  after = bench.motion.reachable ? before.next(now, bench.gaps, bench.contacts) : before;
  after.now = now;
}

void BenchPlant::tell_contact(const BenchSnapshot& bench, const ContactHistory& history,
                              ContactTruth& out) const {
  const ContactForces& contacts = bench.contacts;
  out = ContactTruth();
  out.acquired = history.now;
  out.valid = bench.motion.reachable;
  if (!out.valid) return;
  out.in_contact = history.in_contact;
  out.clamping = both_links_of_a_leg_touch(contacts);
  std::tie(out.strongest, out.second) = strongest_two(contacts);
  out.wrench_in_base = contacts.pylon_wrench;
  out.contacts = history.contacts;
  out.onset = history.onset;
  out.end = history.end;
  out.peak_force = history.peak_force;
  out.self_contact = contacts.self_contact;
  out.self_wrench_in_base = contacts.self_wrench;
}

}  // namespace flinch
