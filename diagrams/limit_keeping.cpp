#include "diagrams/limit_keeping.h"

#include "diagrams/contact_control_settings.h"
#include "systems/framework/constant.h"
#include "systems/laws/kept_motion.h"
#include "systems/laws/limit_keeper.h"
#include "systems/model/robot_model.h"

namespace flinch {
namespace {

/// The drive torque without the filter that aligns it with the velocity.
OutputPort<DriveTorque> add_present_torque(const StageSite& site, const SensedPorts& given) {
  DriveTorqueSettings settings = site.settings.drive_torque;
  settings.low_pass.reset();
  auto& torque = site.builder.add<DriveTorqueMapping>(site.name + "_torque", site.robot, settings);
  site.builder.connect(given.drives, torque.drives);
  site.builder.connect(given.status, torque.status);
  return torque.torque;
}

DisturbanceFilter& add_motion_filter(const StageSite& site, const MotionPorts& given) {
  auto& filter =
      site.builder.add<DisturbanceFilter>(site.name + "_motion", site.robot, site.settings.limits_filter);
  site.builder.connect(given.joints, filter.joints);
  site.builder.connect(given.platform, filter.platform);
  site.builder.connect(given.kinematics, filter.kinematics);
  site.builder.connect(given.dynamics, filter.dynamics);
  site.builder.connect(add_present_torque(site, given), filter.torque);
  return filter;
}

}  // namespace

KeptTorques add_limit_keeper(const StageSite& site, const ReactionPorts& given,
                             OutputPort<TorqueCommand> requested) {
  DiagramBuilder& builder = site.builder;
  if (site.settings.limits.use == LimitKeeperSettings::Use::never)
    return {requested, builder.add<Constant<LimitStatus>>(site.name, LimitStatus()).value};
  DisturbanceFilter& filter = add_motion_filter(site, given);
  auto& model = builder.add<RobotModel>(site.name + "_model", site.robot);
  auto& keeper = builder.add<LimitKeeper>(site.name, site.robot, site.settings.limits);
  auto& kept = builder.add<KeptMotion>(site.name + "_kept_motion", site.settings.limits.use);
  builder.connect(filter.followed, kept.motion);
  builder.connect(given.reaction, kept.reaction);
  builder.connect(kept.kept, model.platform);
  builder.connect(model.kinematics, keeper.kinematics);
  builder.connect(model.dynamics, keeper.dynamics);
  builder.connect(filter.wrench, keeper.disturbance);
  builder.connect(given.reaction, keeper.reaction);
  builder.connect(requested, keeper.request);
  return {keeper.torque, keeper.status};
}

}  // namespace flinch
