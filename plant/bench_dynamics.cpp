#include "plant/bench_dynamics.h"

#include <cmath>
#include <cstddef>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

const BenchSettings& checked(const BenchSettings& settings) {
  throw_if_any(problems(settings));
  return settings;
}

}  // namespace

BenchDynamics::BenchDynamics(const BenchSettings& settings)
    : settings_(checked(settings)),
      robot_(settings.robot),
      contacts_(robot_, settings.pylon, settings.link_material),
      pylon_(settings.pylon.value_or(Pylon{})),
      pylon_moves_(settings.pylon && pylon_.mounting == Pylon::Mounting::compliant) {
  const Eigen::Vector3d pose = initial_state().head<3>();
  if (!robot_.motion(pose, Eigen::Vector3d::Zero()).reachable) {
    throw SetupError("initial_pose is out of the robot's reach");
  }
}

BenchState BenchDynamics::initial_state() const {
  BenchState state = BenchState::Zero(pylon_moves() ? 10 : 6);
  state.head<3>() = settings_.initial_pose.value_or(settings_.robot.home_pose);
  state.segment<3>(3) = settings_.initial_velocity;
  return state;
}

PylonMotion BenchDynamics::pylon_motion(const BenchState& state) const noexcept {
  if (!pylon_moves()) return {pylon_.position_in_base, Eigen::Vector2d::Zero()};
  return {pylon_.position_in_base + state.segment<2>(6), state.segment<2>(8)};
}

Eigen::Vector3d BenchDynamics::brake_torque(const PlanarMotion& motion) const noexcept {
  const auto torque = [&](std::size_t leg) {
    return -settings_.brake.torque * std::tanh(motion.legs[leg].qa_rate / settings_.brake.velocity);
  };
  return {torque(0), torque(1), torque(2)};
}

// Expects out.applied_wrench; fills all else.
void BenchDynamics::solve(const BenchState& state, const DriveAction& drives, ContactCandidates candidates,
                          BenchSnapshot& out) const noexcept {
  out.motion = robot_.motion(state.head<3>(), state.segment<3>(3));
  out.pylon = pylon_motion(state);
  if (!out.motion.reachable) return;
  contacts_.forces(out.motion, out.pylon, candidates, out.contacts);

  Eigen::Vector3d torque = drives.torque;
  if (drives.braked) torque += brake_torque(out.motion);
  out.acceleration = robot_.acceleration(
      out.motion, torque, out.applied_wrench + out.contacts.pylon_wrench + out.contacts.self_wrench);

  out.force_on_pylon_mount = out.contacts.force_on_pylon;
  if (!pylon_moves()) return;
  out.force_on_pylon_mount =
      pylon_.mount_stiffness * state.segment<2>(6) + pylon_.mount_damping * state.segment<2>(8);
  out.pylon_acceleration = (out.contacts.force_on_pylon - out.force_on_pylon_mount) / pylon_.mass;
}

void BenchDynamics::rates(const BenchState& state, const DriveAction& drives,
                          const Eigen::Vector3d& applied_wrench, ContactCandidates candidates,
                          BenchState& rates) const noexcept {
  BenchSnapshot now;
  now.applied_wrench = applied_wrench;
  solve(state, drives, candidates, now);
  rates.resize(state.size());
  if (!now.motion.reachable) {
    rates.setZero();
    return;
  }
  rates.head<3>() = state.segment<3>(3);
  rates.segment<3>(3) = now.acceleration;
  if (!pylon_moves()) return;
  rates.segment<2>(6) = state.segment<2>(8);
  rates.segment<2>(8) = now.pylon_acceleration;
}

void BenchDynamics::snapshot(const BenchState& state, const DriveAction& drives,
                             const Eigen::Vector3d& applied_wrench, BenchSnapshot& out) const noexcept {
  out.applied_wrench = applied_wrench;
  solve(state, drives, ContactCandidates::all(), out);
  if (out.motion.reachable) contacts_.pylon_gaps(out.motion, out.pylon, out.gaps);
}

ContactCandidates BenchDynamics::candidates(const BenchState& state, double duration) const noexcept {
  const PlanarMotion motion = robot_.motion(state.head<3>(), state.segment<3>(3));
  if (!motion.reachable) return ContactCandidates::all();
  return contacts_.candidates(motion, pylon_motion(state), duration);
}

}  // namespace flinch
