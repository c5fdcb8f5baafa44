#include "plant/simulated_force_torque_sensor.h"

#include <cstddef>

#include "plant/setting_problems.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

// Moment about the z axis through `centre` of all forces on the robot.
double moment_about(const Eigen::Vector2d& centre, const ContactForces& contacts) {
  double moment = 0.0;
  for (int i = 0; i < contacts.touch_count; ++i) {
    const Touch& touch = contacts.touches[static_cast<std::size_t>(i)];
    moment += cross(touch.point - centre, touch.force_on_robot);
  }
  return moment;
}

}  // namespace

std::vector<std::string> problems(const SimulatedForceTorqueSettings& settings) {
  SettingProblems problems("force_torque.");
  problems.require_positive("period [s]", to_seconds(settings.period));
  problems.require_not_negative("delay [s]", to_seconds(settings.delay));
  std::vector<std::string> found = problems.found();
  if (!DelayLine<ForceTorqueReading>::can_delay(settings.delay, settings.period)) {
    found.emplace_back(
        "force_torque.delay is longer than the delay line; make it shorter or the period longer");
  }
  return found;
}

SimulatedForceTorqueSensor::SimulatedForceTorqueSensor(const SimulatedForceTorqueSettings& settings,
                                                       const Eigen::Vector2d& pylon_in_base,
                                                       std::uint64_t seed)
    : settings_(settings),
      pylon_in_base_(pylon_in_base),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(derive_seed(seed, "noise")))) {
  throw_if_any(problems(settings));
}

void SimulatedForceTorqueSensor::measure(Time now, const BenchSnapshot& bench, const NormalNumbers<6>& noise,
                                         ForceTorqueReading& reading) const {
  reading = ForceTorqueReading();
  reading.acquired = now;
  reading.valid = bench.motion.reachable;
  if (!reading.valid) return;
  const Eigen::Vector2d force = -bench.force_on_pylon_mount;
  reading.force_in_base << force, 0.0;
  reading.moment_in_base << settings_.depth * normal(force), moment_about(pylon_in_base_, bench.contacts);
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
