#include "plant/simulated_current_sensors.h"

#include "plant/quantisation.h"

namespace flinch {

SimulatedCurrentSensors::SimulatedCurrentSensors(const SimulatedCurrentSensorsSettings& settings,
                                                 int drive_count, std::uint64_t seed)
    : settings_(settings),
      noise_(state<NormalNumbers<max_dof>>(
          "noise", NormalNumbers<max_dof>(drive_count, derive_seed(seed, "noise")))) {}

void SimulatedCurrentSensors::measure(Time now, const DriveAction& acting,
                                      const NormalNumbers<max_dof>& noise, DriveReading& reading) const {
  reading.acquired = now;
  reading.valid = true;
  reading.current = acting.current;
  if (settings_.ideal) return;
  reading.current =
      quantised(JointVector(acting.current + settings_.noise * noise.values()), settings_.resolution);
}

}  // namespace flinch
