#include "plant/imu_clock.h"

#include <algorithm>

#include "systems/foundation/findings.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

Time drawn(Time most, RandomGenerator& generator) {
  return most == Time::zero() ? most : from_seconds(generator.uniform(-1.0, 1.0) * to_seconds(most));
}

}  // namespace

std::vector<std::string> problems(const ImuClockSettings& settings) {
  Findings found("imu.");
  found.positive("period", to_seconds(settings.period), "s");
  found.not_negative("before_tick", to_seconds(settings.before_tick), "s");
  found.not_negative("jitter", to_seconds(settings.jitter), "s");
  found.not_negative("stamp_jitter", to_seconds(settings.stamp_jitter), "s");
  found.not_negative("delay_jitter", to_seconds(settings.delay_jitter), "s");
  found.require(settings.delay_jitter <= Time::zero() ||
                    settings.delay_jitter <= ImuClock::most_periods / 2 * settings.period,
                "delay_jitter must be at most " + std::to_string(ImuClock::most_periods / 2) + " periods");
  found.require(settings.before_tick <= Time::zero() || settings.before_tick < settings.period,
                "before_tick must be shorter than the period");
  const Time most = settings.jitter + settings.stamp_jitter;
  found.require(most <= Time::zero() || 2 * most < settings.period,
                "jitter and stamp_jitter together must be shorter than half the period");
  return found.take();
}

std::int64_t ImuClock::number_at(Time time) const {
  return (time + settings_.before_tick - settings_.jitter) / settings_.period - 1;
}

/// Whatever the samples before it do.
ImuClock::Sample ImuClock::alone(std::int64_t number) const {
  RandomGenerator mixed(seed_ + static_cast<std::uint64_t>(number));
  RandomGenerator generator(mixed());
  Sample sample;
  sample.measured = number * settings_.period - settings_.before_tick + drawn(settings_.jitter, generator);
  sample.stamp = sample.measured + drawn(settings_.stamp_jitter, generator);
  sample.late = drawn(settings_.delay_jitter, generator);
  return sample;
}

ImuClock::Sample ImuClock::sample(std::int64_t number) const {
  Sample sample = alone(number);
  if (settings_.delay_jitter == Time::zero()) return sample;
  for (std::int64_t before = number - most_periods; before < number; ++before) {
    const Sample earlier = alone(before);
    sample.late = std::max(sample.late, earlier.measured + earlier.late - sample.measured);
  }
  sample.stamp += sample.late;
  return sample;
}

}  // namespace flinch
