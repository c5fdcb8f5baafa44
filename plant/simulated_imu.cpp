#include "plant/simulated_imu.h"

#include <Eigen/Geometry>

#include "plant/quantisation.h"
#include "plant/spatial_motion.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

Eigen::Matrix3d platform_to_sensor(const Eigen::Vector3d& angles) {
  const Eigen::Matrix3d R_ES = (Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()))
                                   .toRotationMatrix();
  return R_ES.transpose();
}

Eigen::Vector3d draw_bias(double limit, std::uint64_t seed) {
  RandomGenerator generator(seed);
  return uniform_vector(generator, limit);
}

// Acceleration minus gravity of a point fixed to the platform, in platform axes. [RAL25] (8)
Eigen::Vector3d specific_force(const SpatialMotion& now, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& gravity) {
  const Eigen::Vector3d omega = now.axes.transpose() * now.angular_velocity;
  const Eigen::Vector3d omega_rate = now.axes.transpose() * now.angular_acceleration;
  return now.axes.transpose() * (now.acceleration - gravity) + omega_rate.cross(point) +
         omega.cross(omega.cross(point));
}

}  // namespace

std::vector<std::string> problems(const SimulatedImuSettings& settings) {
  Findings found("imu.");
  found.positive("period", to_seconds(settings.period), "s");
  found.not_negative("delay", to_seconds(settings.delay), "s");
  found.require(DelayLine<ImuReading>::can_delay(settings.delay, settings.period),
                "delay is longer than the delay line; make it shorter or imu.period longer");
  return found.take();
}

SimulatedImu::SimulatedImu(const SimulatedImuSettings& settings, const Mechanism& robot, std::uint64_t seed)
    : settings_(settings),
      space_(robot.space()),
      gravity_(robot.gravity()),
      R_SE_(platform_to_sensor(settings.angles)),
      accelerometer_bias_(draw_bias(settings.accelerometer_bias, derive_seed(seed, "accelerometer bias"))),
      gyroscope_bias_(draw_bias(settings.gyroscope_bias, derive_seed(seed, "gyroscope bias"))),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(6, derive_seed(seed, "noise")))) {
  throw_if_any(problems(settings));
}

void SimulatedImu::measure(const PlantTruth& now, const NormalNumbers<6>& noise, ImuReading& reading) const {
  reading = ImuReading();
  reading.acquired = now.acquired;
  reading.valid = now.valid;
  if (!now.valid) return;
  const SpatialMotion motion = spatial_motion(space_, now.pose, now.velocity, now.acceleration);
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
