#include "diagrams/recorded_station.h"

#include <algorithm>

#include "systems/foundation/setup_error.h"
#include "systems/framework/player.h"
#include "systems/framework/system.h"

namespace flinch {
namespace {

/// Takes what a robot would have obeyed.
class DeafDrives final : public System {
 public:
  InputPort<TorqueCommand> torque_command = input<TorqueCommand>("torque_command");
  InputPort<BrakeCommand> brake = input<BrakeCommand>("brake");
};

bool has_signal(const Recording& recording, const std::string& path) {
  return std::any_of(recording.signals.begin(), recording.signals.end(),
                     [&path](const Signal& signal) { return signal.path == path; });
}

/// The readings of one recording, each behind an output of the station.
struct Playback {
  DiagramBuilder& station;
  const Recording& recording;
  const std::string& prefix;
  const RequestedFaults& faults;

  template <class Reading>
  OutputPort<Reading> add(const std::string& name) const {
    auto& player = station.add<Player<Reading>>(name, recording, prefix + name);
    return station.export_output(name, faults.add(station, name, player.played));
  }
};

Time end_of(const Recording& recording) {
  return recording.time_ns.empty() ? Time::zero() : Time(recording.time_ns.back()) + recording.period;
}

}  // namespace

Station add_recorded_station(DiagramBuilder& builder, const Recording& recording, const std::string& prefix,
                             const RequestedFaults& faults) {
  const bool has_force_torque = has_signal(recording, prefix + "force_torque");
  require_possible(faults.all,
                   {.moves = false, .has_force_torque = has_force_torque, .end = end_of(recording)});
  DiagramBuilder inside("station");
  const auto& drives = inside.add<DeafDrives>("deaf_drives");
  const Playback playback{inside, recording, prefix, faults};
  Station station{.torque_command = inside.export_input("torque_command", drives.torque_command),
                  .brake = inside.export_input("brake", drives.brake),
                  .joints = playback.add<JointReading>("joints"),
                  .drives = playback.add<DriveReading>("drives"),
                  .imu = playback.add<ImuReading>("imu"),
                  .status = playback.add<StationStatus>("status"),
                  .force_torque = std::nullopt,
                  .base_forces = std::nullopt};
  if (has_force_torque) station.force_torque = playback.add<ForceTorqueReading>("force_torque");
  if (has_signal(recording, prefix + "base_forces")) {
    auto& player = inside.add<Player<BaseForceReading>>("base_forces", recording, prefix + "base_forces");
    station.base_forces = inside.export_output("base_forces", player.played);
  }
  builder.add(inside.build());
  return station;
}

}  // namespace flinch
