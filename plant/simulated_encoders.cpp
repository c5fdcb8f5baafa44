#include "plant/simulated_encoders.h"

#include "plant/quantisation.h"

namespace flinch {
namespace {

JointVector constant_error(const EncoderErrors& errors, int count, std::uint64_t seed) {
  RandomGenerator generator(seed);
  return normal_vector(generator, count, errors.accuracy);
}

JointVector measured(const JointVector& position, const EncoderErrors& errors, const JointVector& error,
                     const JointVector& normal) {
  return quantised(JointVector(position + error + errors.noise * normal), errors.resolution);
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
  if (!now.valid || now.active.size() != active || now.passive.size() != passive) return;
  reading.valid = true;
  reading.passive_valid = settings_.passive_mounted && passive > 0;
  reading.active = now.active;
  reading.passive = now.passive;
  if (settings_.ideal) return;
  reading.active = measured(now.active, settings_.active, active_error_, noise.values().head(active));
  reading.passive = measured(now.passive, settings_.passive, passive_error_, noise.values().tail(passive));
}

}  // namespace flinch
