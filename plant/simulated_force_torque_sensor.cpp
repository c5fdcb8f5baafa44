#include "plant/simulated_force_torque_sensor.h"

#include <Eigen/Geometry>
#include <cstddef>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

// Moment about `centre` of all forces of one obstacle on the robot.
Eigen::Vector3d moment_about(const Eigen::Vector3d& centre, int obstacle, const ContactForces& contacts) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int i = 0; i < contacts.touch_count; ++i) {
    const Touch& touch = contacts.touches[static_cast<std::size_t>(i)];
    if (touch.obstacle == obstacle) moment += (touch.point - centre).cross(touch.force_on_robot);
  }
  return moment;
}

}  // namespace

std::vector<std::string> problems(const SimulatedForceTorqueSettings& settings) {
  Findings found("force_torque.");
  found.positive("period", to_seconds(settings.period), "s");
  found.not_negative("delay", to_seconds(settings.delay), "s");
  found.require(DelayLine<ForceTorqueReading>::can_delay(settings.delay, settings.period),
                "delay must be shorter than " + std::to_string(DelayLine<ForceTorqueReading>::longest_delay) +
                    " times the period");
  return found.take();
}

SimulatedForceTorqueSensor::SimulatedForceTorqueSensor(const SimulatedForceTorqueSettings& settings,
                                                       const Eigen::Vector3d& position_in_base,
                                                       std::uint64_t seed)
    : settings_(settings),
      position_in_base_(position_in_base),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(6, derive_seed(seed, "noise")))) {
  throw_if_any(problems(settings));
}

void SimulatedForceTorqueSensor::measure(Time now, const RigSnapshot& rig, const NormalNumbers<6>& noise,
                                         ForceTorqueReading& reading) const {
  reading = ForceTorqueReading();
  reading.acquired = now;
  reading.valid = rig.reachable && settings_.obstacle < rig.obstacle_count;
  if (!reading.valid) return;
  const Eigen::Vector3d force = -rig.force_on_mount[static_cast<std::size_t>(settings_.obstacle)];
  reading.force_in_base = force;
  reading.moment_in_base = settings_.depth * Eigen::Vector3d::UnitZ().cross(force) +
                           moment_about(position_in_base_, settings_.obstacle, rig.contacts);
  if (settings_.ideal) return;
  reading.force_in_base += settings_.force_noise * noise.values().head<3>();
  reading.moment_in_base += settings_.moment_noise * noise.values().tail<3>();
}

void SimulatedForceTorqueSensor::deliver(Time now, const ForceTorqueReading& fresh,
                                         const DelayLine<ForceTorqueReading>& underway,
                                         ForceTorqueReading& reading) const {
  const Time delay = settings_.ideal ? Time::zero() : settings_.delay;
  const bool fresh_is_due = delay == Time::zero() && Every{settings_.period}.due(now);
  const ForceTorqueReading* arrived = fresh_is_due ? &fresh : underway.latest_until(now - delay);
  reading = arrived != nullptr ? *arrived : ForceTorqueReading();
}

}  // namespace flinch
