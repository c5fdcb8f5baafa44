#include "plant/simulated_station.h"

#include "diagrams/requested_fault.h"
#include "plant/rig_plant.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/sampling.h"

namespace flinch {
namespace {

/// The blocks of the station while it is put together.
struct Parts {
  SimulatedDrives& drives;
  RigPlant& plant;
};

Parts add_robot(DiagramBuilder& inside, const SimulatedStationSettings& settings) {
  SimulatedDrivesSettings with_faults = settings.drives;
  for (const RequestedFault& fault : settings.faults) {
    const bool of_torque = fault.signal == FaultSignal::drive && fault.kind == FaultKind::scaled;
    if (fault.signal == FaultSignal::brake || of_torque) with_faults.faults.push_back(fault);
  }
  auto& drives = inside.add<SimulatedDrives>("drives", with_faults, *settings.rig.robot, settings.tick);
  auto& script = inside.add<AppliedWrenchScript>("applied_wrench", settings.applied_wrench);
  auto& plant = inside.add<RigPlant>("plant", settings.rig, settings.tick);
  inside.connect(drives.acting, plant.drives);
  inside.connect(script.wrench, plant.applied);
  inside.connect(plant.truth, drives.truth);
  return {drives, plant};
}

JointCounts measured_joints(const Mechanism& robot) {
  const auto* parallel = dynamic_cast<const ParallelRobot*>(&robot);
  return {.active = robot.drives(), .passive = parallel != nullptr ? parallel->passive_joints() : 0};
}

OutputPort<JointReading> add_encoders(DiagramBuilder& inside, const SimulatedStationSettings& settings,
                                      const Parts& parts) {
  auto& encoders =
      inside.add<SimulatedEncoders>("encoders", settings.encoders, measured_joints(*settings.rig.robot),
                                    derive_seed(settings.seed, "encoders"));
  inside.connect(parts.plant.truth, encoders.truth);
  return encoders.joints;
}

OutputPort<DriveReading> add_current_sensors(DiagramBuilder& inside, const SimulatedStationSettings& settings,
                                             const Parts& parts) {
  auto& sensors =
      inside.add<SimulatedCurrentSensors>("current_sensors", settings.currents, settings.rig.robot->drives(),
                                          derive_seed(settings.seed, "currents"));
  inside.connect(parts.drives.acting, sensors.drives);
  return sensors.currents;
}

OutputPort<ImuReading> add_imu(DiagramBuilder& inside, const SimulatedStationSettings& settings,
                               const Parts& parts) {
  auto& imu = inside.add<SimulatedImu>("imu", settings.imu, *settings.rig.robot,
                                       derive_seed(settings.seed, "imu"), settings.tick);
  inside.connect(parts.plant.truth, imu.truth);
  return imu.imu;
}

std::optional<OutputPort<ForceTorqueReading>> add_force_torque_sensor(
    DiagramBuilder& inside, const SimulatedStationSettings& settings, const Parts& parts) {
  if (!settings.instrument.mountings.empty()) {
    auto& instrument =
        inside.add<SimulatedInstrument>("instrument", settings.instrument, settings.rig.pulls,
                                        settings.rig.robot, derive_seed(settings.seed, "instrument"));
    inside.connect(parts.plant.truth, instrument.truth);
    return instrument.force_torque;
  }
  if (!settings.has_force_torque_sensor()) return std::nullopt;
  const auto obstacle = static_cast<std::size_t>(settings.force_torque->obstacle);
  auto& sensor = inside.add<SimulatedForceTorqueSensor>(
      "force_torque_sensor", *settings.force_torque,
      settings.rig.obstacles[obstacle]->form().position_in_base, derive_seed(settings.seed, "force_torque"));
  inside.connect(parts.plant.snapshot, sensor.snapshot);
  return sensor.force_torque;
}

}  // namespace

void know_period(Time period, SimulatedStationSettings& settings) {
  settings.tick = period;
  settings.drives.longest_silence = longest_age(period);
  if (settings.force_torque) settings.force_torque->period = whole_periods(1ms, period);
}

SimulatedStationSettings with_ideal_sensors(SimulatedStationSettings settings) {
  settings.encoders.ideal = true;
  settings.currents.ideal = true;
  settings.imu.ideal = true;
  settings.instrument.ideal = true;
  if (settings.base_forces) settings.base_forces->ideal = true;
  if (settings.force_torque) settings.force_torque->ideal = true;
  return settings;
}

SimulatedStation add_simulated_station(DiagramBuilder& builder, const SimulatedStationSettings& settings) {
  if (!settings.rig.robot) throw SetupError("a simulated station needs a robot");
  const bool has_instrument = !settings.instrument.mountings.empty();
  require_possible(settings.faults,
                   {.has_passive_encoders = settings.encoders.passive_mounted,
                    .has_force_torque = has_instrument || settings.has_force_torque_sensor()});
  DiagramBuilder inside("station", settings.tick);
  const RequestedFaults faults{settings.faults, settings.tick, settings.seed};
  const Parts parts = add_robot(inside, settings);
  SimulatedStation station;
  station.torque_command = inside.export_input(
      "torque_command", faults.add_before(inside, "torque_command", parts.drives.torque_command));
  station.brake = inside.export_input("brake", faults.add_before(inside, "brake", parts.drives.brake));
  station.joints =
      inside.export_output("joints", faults.add(inside, "joints", add_encoders(inside, settings, parts)));
  station.drives = inside.export_output(
      "drives", faults.add(inside, "drives", add_current_sensors(inside, settings, parts)));
  station.imu = inside.export_output("imu", faults.add(inside, "imu", add_imu(inside, settings, parts)));
  station.status = inside.export_output("status", faults.add(inside, "status", parts.drives.status));
  if (const auto sensor = add_force_torque_sensor(inside, settings, parts)) {
    station.force_torque = inside.export_output("force_torque", faults.add(inside, "force_torque", *sensor));
  }
  if (settings.base_forces) {
    auto& sensors =
        inside.add<SimulatedBaseForces>("base_force_sensors", *settings.base_forces, settings.rig.robot,
                                        derive_seed(settings.seed, "base_forces"));
    inside.connect(parts.plant.snapshot, sensors.snapshot);
    station.base_forces = inside.export_output("base_forces", sensors.forces);
  }
  station.plant_truth = inside.export_output("truth", parts.plant.truth);
  station.contact_truth = inside.export_output("contact_truth", parts.plant.contact);
  station.obstacle_truth = inside.export_output("obstacle_truth", parts.plant.obstacles);
  station.platform_truth = inside.export_output("platform_truth", parts.plant.platform);
  builder.add(inside.build());
  return station;
}

}  // namespace flinch
