#include "diagrams/external_station.h"

#include <string>

#include "diagrams/reading_guard.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

template <class Reading>
struct Guarded {
  InputPort<Arrival<Reading>> arriving;
  OutputPort<Reading> reading;
  OutputPort<LinkStatus> link;
};

template <class Reading>
Guarded<Reading> add_guard(DiagramBuilder& inside, const std::string& name, const GuardSettings& settings) {
  auto& guard = inside.add<ReadingGuard<Reading>>(name + "_guard", settings);
  return {inside.export_input("arriving_" + name, guard.arrival), inside.export_output(name, guard.reading),
          inside.export_output(name + "_link", guard.link)};
}

/// Makes an input of the station one of the outer diagram, under the same name.
template <class Reading>
InputPort<Arrival<Reading>> let_in(DiagramBuilder& builder, InputPort<Arrival<Reading>> inner) {
  return builder.export_input(inner.id.owner->port_name(inner.id), inner);
}

void check(const ExternalStationSettings& settings) {
  if (settings.max_age <= Time::zero() || settings.max_imu_age <= Time::zero()) {
    throw SetupError("the largest age of readings from outside must be positive");
  }
}

}  // namespace

ExternalStation add_external_station(DiagramBuilder& builder,
                                     const std::shared_ptr<const ParallelRobot>& robot,
                                     const ExternalStationSettings& settings) {
  check(settings);
  DiagramBuilder inside("station");
  const JointCount count{.drives = robot->drives(), .passive = robot->passive_joints()};
  const GuardSettings usual{.robot = count, .max_age = settings.max_age, .lockstep = settings.lockstep};
  GuardSettings of_imu = usual;
  of_imu.max_age = settings.max_imu_age;
  const auto joints = add_guard<JointReading>(inside, "joints", usual);
  const auto drives = add_guard<DriveReading>(inside, "drives", usual);
  const auto imu = add_guard<ImuReading>(inside, "imu", of_imu);
  const auto status = add_guard<StationStatus>(inside, "status", usual);
  std::optional<Guarded<ForceTorqueReading>> sensor;
  if (settings.force_torque) {
    sensor = add_guard<ForceTorqueReading>(inside, "force_torque", usual);
  }

  ExternalStation station;
  station.torque_command = inside.input<TorqueCommand>("torque_command");
  station.brake = inside.input<BrakeCommand>("brake");
  builder.add(inside.build());

  station.joints = joints.reading;
  station.drives = drives.reading;
  station.imu = imu.reading;
  station.status = status.reading;
  station.joints_link = joints.link;
  station.drives_link = drives.link;
  station.imu_link = imu.link;
  station.status_link = status.link;
  station.arriving_joints = let_in(builder, joints.arriving);
  station.arriving_drives = let_in(builder, drives.arriving);
  station.arriving_imu = let_in(builder, imu.arriving);
  station.arriving_status = let_in(builder, status.arriving);
  if (sensor) {
    station.force_torque = sensor->reading;
    station.arriving_force_torque = let_in(builder, sensor->arriving);
  }
  return station;
}

}  // namespace flinch
