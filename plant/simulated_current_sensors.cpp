#include "plant/simulated_current_sensors.h"

#include "plant/quantisation.h"

namespace flinch {

SimulatedCurrentSensors::SimulatedCurrentSensors(const SimulatedCurrentSensorsSettings& settings,
                                                 std::uint64_t seed)
    : settings_(settings),
      noise_(state<NormalNumbers<3>>("noise", NormalNumbers<3>(derive_seed(seed, "noise")))) {}

void SimulatedCurrentSensors::measure(Time now, const DriveAction& acting, const NormalNumbers<3>& noise,
                                      DriveReading& reading) const {
  reading.acquired = now;
  reading.valid = true;
  reading.current = acting.current;
  if (settings_.ideal) return;
  const Eigen::Vector3d noisy = acting.current + settings_.noise * noise.values();
  reading.current = quantised(noisy, settings_.resolution);
}

}  // namespace flinch
