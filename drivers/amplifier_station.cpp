#include "drivers/amplifier_station.h"

#include "drivers/drive_manager.h"
#include "drivers/power_stage.h"

namespace flinch {

AmplifierStation add_amplifier_station(DiagramBuilder& builder, const ExternalStation& fieldbus) {
  DiagramBuilder inside("power");
  auto& group = inside.add<DriveGroup>("group");
  auto& master = inside.add<DriveManager>("master");
  auto& stage = inside.add<PowerStage>("stage");
  inside.connect(group.statusword, master.statusword);
  inside.connect(group.statusword, stage.statusword);

  AmplifierStation station;
  static_cast<Station&>(station) = static_cast<const Station&>(fieldbus);
  const auto statuswords = inside.export_input("statuswords", group.drives);
  const auto wish = inside.export_input("wish", master.wish);
  inside.connect(wish, stage.wish);
  const auto wanted_torque = inside.export_input("torque_command", stage.wanted_torque);
  const auto wanted_brake = inside.export_input("brake", stage.wanted_brake);
  const auto bare_status = inside.export_input("bare_status", stage.bare_status);
  const auto passed_torque = inside.export_output("passed_torque_command", stage.torque_command);
  const auto passed_brake = inside.export_output("passed_brake", stage.brake);
  station.status = inside.export_output("status", stage.status);
  station.statusword = inside.export_output("statusword", group.statusword);
  station.controlword = inside.export_output("controlword", master.controlword);
  builder.add(inside.build());

  builder.connect(fieldbus.status, bare_status);
  builder.connect(passed_torque, fieldbus.torque_command);
  builder.connect(passed_brake, fieldbus.brake);
  station.statuswords = builder.export_input("statuswords", statuswords);
  station.wish = builder.export_input("wish", wish);
  station.torque_command = builder.export_input("torque_command", wanted_torque);
  station.brake = builder.export_input("brake", wanted_brake);
  return station;
}

}  // namespace flinch
