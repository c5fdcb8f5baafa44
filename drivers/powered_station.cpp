#include "drivers/powered_station.h"

#include "drivers/drive_manager.h"
#include "drivers/drive_monitor.h"
#include "drivers/power_stage.h"

namespace flinch {

PoweredStation add_powered_station(DiagramBuilder& builder, const Station& bare) {
  DiagramBuilder inside("power");
  auto& master = inside.add<DriveManager>("master");
  auto& machine = inside.add<DriveStateMachine>("state_machine");
  auto& watch = inside.add<DriveMonitor>("watch");
  auto& stage = inside.add<PowerStage>("stage");
  inside.connect(machine.statusword, master.statusword);
  inside.connect(master.controlword, machine.controlword);
  inside.connect(watch.condition, machine.condition);
  inside.connect(machine.statusword, stage.statusword);

  PoweredStation station;
  static_cast<Station&>(station) = bare;
  station.wish = inside.export_input("wish", master.wish);
  inside.connect(station.wish, stage.wish);
  station.torque_command = inside.export_input("torque_command", stage.wanted_torque);
  station.brake = inside.export_input("brake", stage.wanted_brake);
  const auto bare_status = inside.export_input("bare_status", stage.bare_status);
  inside.connect(bare_status, watch.status);
  const auto joints = inside.export_input("joints", watch.joints);
  const auto torque_command = inside.export_output("passed_torque_command", stage.torque_command);
  const auto brake = inside.export_output("passed_brake", stage.brake);
  station.status = inside.export_output("status", stage.status);
  station.statusword = inside.export_output("statusword", machine.statusword);
  builder.add(inside.build());

  builder.connect(bare.status, bare_status);
  builder.connect(bare.joints, joints);
  builder.connect(torque_command, bare.torque_command);
  builder.connect(brake, bare.brake);
  return station;
}

}  // namespace flinch
