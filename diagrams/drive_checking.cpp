#include "diagrams/drive_checking.h"

#include "diagrams/contact_control_settings.h"
#include "systems/framework/constant.h"

namespace flinch {

CheckedTorques add_drive_check(const StageContext& site, const ReactionPorts& given,
                               OutputPort<TorqueCommand> torque, const PlatformTrajectory& trajectory) {
  if (!site.settings.checks_drives || !site.settings.plausibility.commands_act) {
    auto& unwanted = site.builder.add<Constant<DriveCheckStatus>>("no_" + site.name, DriveCheckStatus());
    site.builder.connect(unwanted.value, trajectory.drive_check);
    return {torque, unwanted.value, false};
  }
  auto& check = site.builder.add<DriveCheck>(site.name, site.robot, site.settings.drive_check);
  site.builder.connect(torque, check.command);
  site.builder.connect(given.joints, check.joints);
  site.builder.connect(given.kinematics, check.kinematics);
  site.builder.connect(given.dynamics, check.dynamics);
  site.builder.connect(given.reaction, check.reaction);
  site.builder.connect(trajectory.reference, check.reference);
  site.builder.connect(check.status, trajectory.drive_check);
  return {check.torque, check.status, true};
}

}  // namespace flinch
