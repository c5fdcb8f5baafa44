#pragma once

#include <memory>

#include "diagrams/arrival.h"
#include "diagrams/link_status.h"
#include "diagrams/station.h"
#include "systems/framework/diagram_builder.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// A robot outside this program.
struct ExternalStationSettings {
  Time max_age = 3ms;         ///< of a reading, by its acquisition; older ones are not valid
  Time max_imu_age = 10ms;    ///< the unit itself delays its samples by 3 to 4 ms, [RAL25] V-B
  bool force_torque = false;  ///< the instrument is mounted
  /// The robot is simulated and waits for each tick, so that its readings are of the tick itself, as in one
  /// program with it: they are shown as they are, old ones and those of broken sensors as well.
  bool lockstep = false;
};

/// The station's ports, and where its readings come in: inputs of the outer diagram, which whoever runs it
/// sets before each tick. What goes out is read after the tick from `torque_command` and `brake`.
struct ExternalStation : Station {
  InputPort<Arrival<JointReading>> arriving_joints;
  InputPort<Arrival<DriveReading>> arriving_drives;
  InputPort<Arrival<ImuReading>> arriving_imu;
  InputPort<Arrival<StationStatus>> arriving_status;
  std::optional<InputPort<Arrival<ForceTorqueReading>>> arriving_force_torque;

  // What is worth recording.
  OutputPort<LinkStatus> joints_link;
  OutputPort<LinkStatus> drives_link;
  OutputPort<LinkStatus> imu_link;
  OutputPort<LinkStatus> status_link;
};

/// Adds the station as one nested diagram, "station", with a ReadingGuard for each reading, and its inputs to
/// `builder`, which must build the outermost diagram. Throws SetupError for ages that are not positive.
ExternalStation add_external_station(DiagramBuilder& builder,
                                     const std::shared_ptr<const ParallelRobot>& robot,
                                     const ExternalStationSettings& settings = {});

}  // namespace flinch
