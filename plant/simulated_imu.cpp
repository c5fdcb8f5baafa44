#include "plant/simulated_imu.h"

#include "plant/quantisation.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

Eigen::Vector3d draw_bias(double limit, std::uint64_t seed) {
  RandomGenerator generator(seed);
  return uniform_vector(generator, limit);
}

}  // namespace

std::vector<std::string> problems(const SimulatedImuSettings& settings) {
  Findings found("imu.");
  found.positive("period", to_seconds(settings.period), "s");
  found.not_negative("delay", to_seconds(settings.delay), "s");
  found.not_negative("before_tick", to_seconds(settings.before_tick), "s");
  found.require(settings.before_tick <= Time::zero() || settings.before_tick < settings.period,
                "before_tick must be shorter than the period");
  found.require(DelayLine<ImuReading>::can_delay(settings.delay, settings.period),
                "delay must be shorter than " + std::to_string(DelayLine<ImuReading>::longest_delay) +
                    " times the period");
  return found.take();
}

SimulatedImu::SimulatedImu(const SimulatedImuSettings& settings, const Mechanism& robot, std::uint64_t seed)
    : settings_(settings),
      space_(robot.space()),
      gravity_(robot.gravity()),
      R_SE_(platform_to_sensor(settings.mount())),
      accelerometer_bias_(draw_bias(settings.accelerometer_bias, derive_seed(seed, "accelerometer bias"))),
      gyroscope_bias_(draw_bias(settings.gyroscope_bias, derive_seed(seed, "gyroscope bias"))),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(6, derive_seed(seed, "noise")))) {
  throw_if_any(problems(settings));
}

/// The motion so many seconds before, under the acceleration of now.
SpatialMotion SimulatedImu::motion_before(const PlantTruth& now, double seconds) const {
  if (seconds == 0.0) return spatial_motion(space_, now.pose, now.velocity, now.acceleration);
  const PlatformVector velocity = now.velocity - seconds * now.acceleration;
  const PlatformVector way = -0.5 * seconds * (now.velocity + velocity);
  return spatial_motion(space_, space_.plus(now.pose, way), velocity, now.acceleration);
}

void SimulatedImu::measure(const PlantTruth& now, const NormalNumbers<6>& noise, ImuReading& reading) const {
  reading = ImuReading();
  const Time before = settings_.ideal ? Time::zero() : settings_.before_tick;
  reading.acquired = now.acquired - before;
  reading.valid = now.valid;
  if (!now.valid) return;
  const SpatialMotion motion = motion_before(now, to_seconds(before));
  reading.angular_velocity = R_SE_ * motion.axes.transpose() * motion.angular_velocity;
  reading.specific_force = R_SE_ * specific_force(motion, settings_.position_in_platform, gravity_);
  if (settings_.ideal) return;

  const double gyroscope_noise = noise_deviation(settings_.gyroscope_density, settings_.period);
  const double accelerometer_noise = noise_deviation(settings_.accelerometer_density, settings_.period);
  reading.angular_velocity += gyroscope_bias_ + gyroscope_noise * noise.values().head<3>();
  reading.specific_force += accelerometer_bias_ + accelerometer_noise * noise.values().tail<3>();
  reading.angular_velocity = quantised(reading.angular_velocity, settings_.gyroscope_resolution);
  reading.specific_force = quantised(reading.specific_force, settings_.accelerometer_resolution);
}

void SimulatedImu::deliver(Time now, const ImuReading& fresh, const DelayLine<ImuReading>& underway,
                           ImuReading& reading) const {
  const Time delay = settings_.ideal ? Time::zero() : settings_.delay;
  const bool fresh_is_due = delay == Time::zero() && Every{settings_.period}.due(now);
  const ImuReading* arrived = fresh_is_due ? &fresh : underway.latest_until(now - delay);
  reading = arrived != nullptr ? *arrived : ImuReading();
}

}  // namespace flinch
