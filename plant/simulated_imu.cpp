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

/// An ideal one has no lead and no jitter.
ImuClockSettings clock_of(const SimulatedImuSettings& settings) {
  if (!settings.ideal) return settings.clock;
  return {.period = settings.clock.period};
}

}  // namespace

std::vector<std::string> problems(const SimulatedImuSettings& settings) {
  std::vector<std::string> all = problems(settings.clock);
  Findings found("imu.");
  found.not_negative("delay", to_seconds(settings.delay), "s");
  found.require(settings.clock.delay_jitter <= settings.delay,
                "delay_jitter must not be longer than the delay");
  found.require(DelayLine<ImuSamples::Sample>::can_delay(settings.delay + settings.clock.delay_jitter,
                                                         settings.clock.period),
                "delay, with its jitter, must be shorter than " +
                    std::to_string(DelayLine<ImuReading>::longest_delay) + " times the period");
  for (std::string& problem : found.take()) all.push_back(std::move(problem));
  return all;
}

SimulatedImu::SimulatedImu(const SimulatedImuSettings& settings, const Mechanism& robot, std::uint64_t seed,
                           Time tick)
    : settings_(settings),
      tick_(tick),
      clock_(clock_of(settings), derive_seed(seed, "clock")),
      space_(robot.space()),
      gravity_(robot.gravity()),
      R_SE_(platform_to_sensor(settings.mount())),
      accelerometer_bias_(settings.fixed_accelerometer_bias.value_or(
          draw_bias(settings.accelerometer_bias, derive_seed(seed, "accelerometer bias")))),
      gyroscope_bias_(draw_bias(settings.gyroscope_bias, derive_seed(seed, "gyroscope bias"))),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(6, derive_seed(seed, "noise")))) {
  std::vector<std::string> all = problems(settings);
  constexpr int most = ImuSamples::most - 1;
  if (all.empty() && tick > most * settings.clock.period)
    all.push_back("imu.rate must be at most " + std::to_string(most) + " samples a tick");
  throw_if_any(all);
}

/// The motion so many seconds before, under the acceleration of now.
SpatialMotion SimulatedImu::motion_before(const PlantTruth& now, double seconds) const {
  if (seconds == 0.0) return spatial_motion(space_, now.pose, now.velocity, now.acceleration);
  const PlatformVector velocity = now.velocity - seconds * now.acceleration;
  const PlatformVector way = -0.5 * seconds * (now.velocity + velocity);
  return spatial_motion(space_, space_.plus(now.pose, way), velocity, now.acceleration);
}

void SimulatedImu::read(const PlantTruth& now, Time before, const NormalNumbers<6>& noise,
                        ImuReading& reading) const {
  reading.valid = now.valid;
  if (!now.valid) return;
  const SpatialMotion motion = motion_before(now, to_seconds(before));
  reading.angular_velocity = R_SE_ * motion.axes.transpose() * motion.angular_velocity;
  reading.specific_force = R_SE_ * specific_force(motion, settings_.position_in_platform, gravity_);
  if (settings_.ideal) return;

  const Time period = settings_.clock.period;
  const double gyroscope_noise = noise_deviation(settings_.gyroscope_density, period);
  const double accelerometer_noise = noise_deviation(settings_.accelerometer_density, period);
  reading.angular_velocity += gyroscope_bias_ + gyroscope_noise * noise.values().head<3>();
  reading.specific_force += accelerometer_bias_ + accelerometer_noise * noise.values().tail<3>();
  reading.angular_velocity = quantised(reading.angular_velocity, settings_.gyroscope_resolution);
  reading.specific_force = quantised(reading.specific_force, settings_.accelerometer_resolution);
}

void SimulatedImu::measure(const PlantTruth& now, const NormalNumbers<6>& noise, ImuSamples& measured) const {
  measured.count = 0;
  NormalNumbers<6> numbers = noise;
  for (std::int64_t i = clock_.number_at(now.acquired - tick_); measured.count < ImuSamples::most; ++i) {
    const ImuClock::Sample instant = clock_.sample(i);
    if (instant.measured > now.acquired) break;
    if (instant.measured <= now.acquired - tick_) continue;
    if (measured.count > 0) numbers.draw();
    ImuSamples::Sample& sample = measured.samples[static_cast<std::size_t>(measured.count++)];
    sample = {.acquired = instant.measured + instant.late, .reading = {}};
    sample.reading.acquired = instant.stamp;
    read(now, now.acquired - instant.measured, numbers, sample.reading);
  }
}

void SimulatedImu::deliver(Time now, const ImuSamples& fresh, const DelayLine<ImuSamples::Sample>& underway,
                           ImuReading& reading) const {
  const Time due = now - (settings_.ideal ? Time::zero() : settings_.delay);
  const ImuSamples::Sample* arrived = underway.latest_until(due);
  for (int i = 0; i < fresh.count; ++i) {
    const ImuSamples::Sample& sample = fresh.samples[static_cast<std::size_t>(i)];
    if (sample.acquired <= due) arrived = &sample;
  }
  reading = arrived != nullptr ? arrived->reading : ImuReading();
}

void SimulatedImu::send(const ImuSamples& fresh, DelayLine<ImuSamples::Sample>& underway) const {
  for (int i = 0; i < fresh.count; ++i) underway.push(fresh.samples[static_cast<std::size_t>(i)]);
}

void SimulatedImu::draw(const ImuSamples& fresh, NormalNumbers<6>& noise) const {
  for (int i = 0; i < fresh.count; ++i) noise.draw();
}

}  // namespace flinch
