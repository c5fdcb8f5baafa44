#include "plant/simulated_encoders.h"

#include "plant/quantisation.h"

namespace flinch {
namespace {

Eigen::Vector3d constant_error(const EncoderErrors& errors, std::uint64_t seed) {
  RandomGenerator generator(seed);
  return normal_vector(generator, errors.accuracy);
}

}  // namespace

SimulatedEncoders::SimulatedEncoders(const SimulatedEncodersSettings& settings, std::uint64_t seed)
    : settings_(settings),
      active_error_(constant_error(settings.active, derive_seed(seed, "active accuracy"))),
      passive_error_(constant_error(settings.passive, derive_seed(seed, "passive accuracy"))),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(derive_seed(seed, "noise")))) {}

void SimulatedEncoders::measure(const PlantTruth& now, const NormalNumbers<6>& noise,
                                JointReading& reading) const {
  reading = JointReading();
  reading.acquired = now.acquired;
  if (!now.valid) return;
  reading.valid = true;
  reading.passive_valid = settings_.passive_mounted;
  reading.active = now.active;
  reading.passive = now.passive;
  if (settings_.ideal) return;

  const auto measured = [](const JointVector& angle, const EncoderErrors& errors,
                           const Eigen::Vector3d& error, const Eigen::Vector3d& normal) -> Eigen::Vector3d {
    return quantised(Eigen::Vector3d(angle + error + errors.noise * normal), errors.resolution);
  };
  reading.active = measured(now.active, settings_.active, active_error_, noise.values().head<3>());
  reading.passive = measured(now.passive, settings_.passive, passive_error_, noise.values().tail<3>());
}

}  // namespace flinch
