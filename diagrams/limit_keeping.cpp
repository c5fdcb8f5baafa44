#include "diagrams/limit_keeping.h"

#include "diagrams/contact_control_settings.h"
#include "diagrams/lagless_motion.h"
#include "systems/framework/constant.h"
#include "systems/laws/kept_motion.h"
#include "systems/laws/limit_keeper.h"
#include "systems/model/robot_model.h"

namespace flinch {
KeptTorques add_limit_keeper(const StageSite& site, const ReactionPorts& given,
                             OutputPort<TorqueCommand> requested) {
  DiagramBuilder& builder = site.builder;
  if (site.settings.limits.use == LimitKeeperSettings::Use::never)
    return {requested, builder.add<Constant<LimitStatus>>(site.name, LimitStatus()).value};
  DisturbanceFilter& filter = add_encoder_filter(part(site, "motion"), given, site.settings.limits_filter);
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
