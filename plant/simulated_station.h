#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "diagrams/faulty_value.h"
#include "diagrams/station.h"
#include "plant/applied_wrench.h"
#include "plant/contact_truth.h"
#include "plant/obstacle_truth.h"
#include "plant/plant_truth.h"
#include "plant/rig_settings.h"
#include "plant/simulated_base_forces.h"
#include "plant/simulated_current_sensors.h"
#include "plant/simulated_drives.h"
#include "plant/simulated_encoders.h"
#include "plant/simulated_force_torque_sensor.h"
#include "plant/simulated_imu.h"
#include "plant/simulated_instrument.h"
#include "systems/framework/diagram_builder.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// A simulated rig with its drives and sensors.
struct SimulatedStationSettings {
  RigSettings rig;
  SimulatedDrivesSettings drives;
  SimulatedEncodersSettings encoders;
  SimulatedCurrentSensorsSettings currents;
  SimulatedImuSettings imu;
  /// Mounted where there is the obstacle that it names.
  std::optional<SimulatedForceTorqueSettings> force_torque = SimulatedForceTorqueSettings{};
  /// In the place of the sensor below an obstacle, where it has mountings.
  SimulatedInstrumentSettings instrument;
  /// Sensors below the base joints; none: there are none.
  std::optional<SimulatedBaseForcesSettings> base_forces{};
  std::vector<WrenchRamp> applied_wrench;  ///< Pushes on the platform.

  std::vector<RequestedFault> faults;  ///< Of sensors, drives, brakes and of the link to the control path.

  /// Who says what touches the robot, in the place of a classifier; empty: nobody. "truth": what does. The
  /// name of a class: that one from the first touch of a body that has to do with it on.
  std::string told_contact;

  std::uint64_t seed = 0;  ///< Of the run; each sensor derives its own.
  Time tick = 1ms;         ///< The time between ticks of the diagram, or a multiple of it.

  bool has_force_torque_sensor() const {
    return force_torque && force_torque->obstacle >= 0 &&
           static_cast<std::size_t>(force_torque->obstacle) < rig.obstacles.size();
  }
};

/// What follows from the time between two ticks of the control path: sensors that measure with the ticks do
/// so at 1 kHz or as often as there are ticks.
void know_period(Time period, SimulatedStationSettings& settings);

/// The same with sensors that tell the truth, at once.
SimulatedStationSettings with_ideal_sensors(SimulatedStationSettings settings);

/// The station's ports, and the truth, which no control block may read.
struct SimulatedStation : Station {
  OutputPort<PlantTruth> plant_truth;
  OutputPort<ContactTruth> contact_truth;
  OutputPort<ObstacleTruth> obstacle_truth;
  /// Pose and velocity as sensors would tell them without errors.
  OutputPort<PlatformMotion> platform_truth;
};

/// Adds the simulated rig as one nested diagram, "station". Its continuous state wants an adaptive
/// integrator: SundialsIntegrator. Throws SetupError for settings that describe no rig.
SimulatedStation add_simulated_station(DiagramBuilder& builder, const SimulatedStationSettings& settings);

}  // namespace flinch
