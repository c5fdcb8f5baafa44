#pragma once

#include <cstdint>

#include "plant/drive_action.h"
#include "plant/sensor_noise.h"
#include "systems/framework/system.h"
#include "systems/signals/drive_reading.h"

namespace flinch {

/// How far the measured motor currents are off the truth.
struct SimulatedCurrentSensorsSettings {
  bool ideal = false;       ///< Readings are the truth.
  double noise = 0.02;      ///< Standard deviation of white noise [A]; assumed: 0.1 Nm at the rig's 6 Nm/A.
  double resolution = 0.0;  ///< Readings are multiples of it [A]; zero: continuous.
};

/// Measures the currents that have acted until the tick.
class SimulatedCurrentSensors final : public System {
 public:
  SimulatedCurrentSensors(const SimulatedCurrentSensorsSettings& settings, int drive_count,
                          std::uint64_t seed);

 private:
  SimulatedCurrentSensorsSettings settings_;
  State<NormalNumbers<max_dof>> noise_;

 public:
  InputPort<DriveAction> drives = input<DriveAction>("drives");
  OutputPort<DriveReading> currents =
      output<&SimulatedCurrentSensors::measure>("currents", clock, drives, noise_);

 private:
  Update draw_ = update<&SimulatedCurrentSensors::draw>(noise_);

  void measure(Time now, const DriveAction& acting, const NormalNumbers<max_dof>& noise,
               DriveReading& reading) const;
  void draw(NormalNumbers<max_dof>& noise) const { noise.draw(); }
};

}  // namespace flinch
