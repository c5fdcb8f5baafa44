#include "diagrams/lagless_motion.h"

#include "diagrams/contact_control_settings.h"
#include "systems/model/robot_model.h"

namespace flinch {

StageSite part(const StageSite& site, const std::string& what) {
  return {site.builder, site.name + "_" + what, site.robot, site.settings, site.loads};
}

OutputPort<DriveTorque> add_drive_torque(const StageSite& site, const SensedPorts& given,
                                         const std::optional<LowPassSettings>& aligned_with) {
  auto& torque =
      site.builder.add<DriveTorqueMapping>(site.name, site.robot, site.settings.drive_torque, aligned_with);
  site.builder.connect(given.joints, torque.joints);
  site.builder.connect(given.drives, torque.drives);
  site.builder.connect(given.status, torque.status);
  return torque.torque;
}

DisturbanceFilter& add_encoder_filter(const StageSite& site, const MotionPorts& given,
                                      const DisturbanceFilterSettings& settings) {
  DiagramBuilder& builder = site.builder;
  auto& filter = builder.add<DisturbanceFilter>(site.name, site.robot, settings);
  builder.connect(given.joints, filter.joints);
  builder.connect(given.platform, filter.platform);
  builder.connect(given.kinematics, filter.kinematics);
  builder.connect(given.dynamics, filter.dynamics);
  builder.connect(add_drive_torque(part(site, "torque"), given), filter.torque);
  return filter;
}

LaglessPorts without_lag(const StageSite& site, const AcceleratedPorts& given) {
  const DisturbanceFilter& filter =
      add_encoder_filter(part(site, "velocity"), given, site.settings.disturbance_filter);
  LaglessPorts present{given, filter.wrench};
  present.platform = filter.followed;
  auto& model = site.builder.add<MotionModel>(site.name + "_model", site.robot);
  site.builder.connect(present.platform, model.platform);
  present.kinematics = model.kinematics;
  present.dynamics = model.dynamics;
  return present;
}

}  // namespace flinch
