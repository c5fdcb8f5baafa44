#include "plant/simulated_encoders.h"

#include <cstddef>
#include <string>

#include "plant/quantisation.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void check_count(const char* name, std::ptrdiff_t count, int encoders) {
  if (count == 0 || count == encoders) return;
  throw SetupError("encoders: " + std::string(name) + " has " + std::to_string(count) +
                   " entries; there are " + std::to_string(encoders) + " encoders");
}

JointVector constant_error(const EncoderErrors& errors, int count, std::uint64_t seed) {
  check_count("offset", errors.offset.size(), count);
  check_count("wave", static_cast<std::ptrdiff_t>(errors.wave.size()), count);
  RandomGenerator generator(seed);
  JointVector error = normal_vector(generator, count, errors.accuracy);
  if (errors.offset.size() > 0) error += errors.offset;
  return error;
}

JointVector measured(const JointVector& position, const EncoderErrors& errors, const JointVector& error,
                     const JointVector& normal) {
  JointVector read = position + error + errors.noise * normal;
  for (std::size_t i = 0; i < errors.wave.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    read[joint] += errors.wave[i].at(position[joint]);
  }
  return quantised(read, errors.resolution);
}

}  // namespace

SimulatedEncoders::SimulatedEncoders(const SimulatedEncodersSettings& settings, const JointCounts& counts,
                                     std::uint64_t seed)
    : settings_(settings),
      active_error_(constant_error(settings.active, counts.active, derive_seed(seed, "active accuracy"))),
      passive_error_(constant_error(settings.passive, counts.passive, derive_seed(seed, "passive accuracy"))),
      noise_(state<Noise>("noise", Noise(counts.active + counts.passive, derive_seed(seed, "noise")))) {}

void SimulatedEncoders::measure(const PlantTruth& now, const Noise& noise, JointReading& reading) const {
  reading = JointReading();
  reading.acquired = now.acquired;
  const auto active = active_error_.size();
  const auto passive = passive_error_.size();
  if (!now.valid || now.motor_positions().size() != active || now.passive.size() != passive) return;
  reading.valid = true;
  reading.passive_valid = settings_.passive_mounted && passive > 0;
  reading.active = now.motor_positions();
  reading.passive = now.passive;
  if (settings_.ideal) return;
  reading.active =
      measured(now.motor_positions(), settings_.active, active_error_, noise.values().head(active));
  reading.passive = measured(now.passive, settings_.passive, passive_error_, noise.values().tail(passive));
}

}  // namespace flinch
