#include "diagrams/limit_keeping.h"

#include "diagrams/contact_control_settings.h"
#include "diagrams/lagless_motion.h"
#include "systems/framework/constant.h"
#include "systems/laws/braking_watch.h"
#include "systems/laws/kept_motion.h"
#include "systems/laws/limit_keeper.h"
#include "systems/model/robot_model.h"
#include "systems/safety/stopping_motion.h"

namespace flinch {
namespace {

/// A keeper with a model of its own: it is evaluated in the ticks in which there is a motion.
LimitKeeper& add_keeper(const StageSite& site, OutputPort<PlatformMotion> motion,
                        OutputPort<WrenchEstimate> disturbance, OutputPort<TorqueCommand> requested) {
  DiagramBuilder& builder = site.builder;
  auto& model = builder.add<MotionModel>(site.name + "_model", site.robot);
  auto& keeper = builder.add<LimitKeeper>(site.name, site.robot, site.settings.limits);
  builder.connect(motion, model.platform);
  builder.connect(motion, keeper.motion);
  builder.connect(model.kinematics, keeper.kinematics);
  builder.connect(model.dynamics, keeper.dynamics);
  builder.connect(disturbance, keeper.disturbance);
  builder.connect(requested, keeper.request);
  return keeper;
}

OutputPort<BrakingStatus> add_braking_watch(const StageSite& site, OutputPort<PlatformMotion> motion,
                                            OutputPort<ReactionState> reaction) {
  const LimitKeeperSettings& kept = site.settings.limits;
  auto& watch = site.builder.add<BrakingWatch>("braking", site.robot, kept.limits,
                                               planned_torque_share * kept.max_torque);
  site.builder.connect(motion, watch.motion);
  site.builder.connect(reaction, watch.reaction);
  return watch.status;
}

}  // namespace

KeptTorques add_limit_keeper(const StageSite& site, const ReactionPorts& given,
                             OutputPort<TorqueCommand> requested) {
  DiagramBuilder& builder = site.builder;
  if (site.settings.limits.use == LimitKeeperSettings::Use::never)
    return {requested, builder.add<Constant<LimitStatus>>(site.name, LimitStatus()).value,
            builder.add<Constant<BrakingStatus>>("braking", BrakingStatus()).value};
  DisturbanceFilter& filter = add_encoder_filter(part(site, "motion"), given, site.settings.limits_filter);
  auto& kept = builder.add<KeptMotion>(site.name + "_kept_motion", site.settings.limits.use);
  builder.connect(filter.followed, kept.motion);
  builder.connect(given.reaction, kept.reaction);
  LimitKeeper& keeper = add_keeper(site, kept.kept, filter.wrench, requested);
  return {keeper.torque, keeper.status, add_braking_watch(site, filter.followed, given.reaction),
          keeper.commanded, FollowedMotion{filter.followed, filter.wrench}};
}

OutputPort<TorqueCommand> add_kept_stop(const StageSite& site, const FollowedMotion& followed,
                                        const StopPorts& stop) {
  DiagramBuilder& builder = site.builder;
  auto& motion = builder.add<StoppingMotion>(site.name + "_motion");
  builder.connect(followed.platform, motion.motion);
  builder.connect(stop.faults, motion.faults);
  builder.connect(stop.gate, motion.gate);
  LimitKeeper& keeper = add_keeper(site, motion.trusted, followed.disturbance, stop.torque);
  builder.connect(stop.commanded, keeper.commanded);
  return keeper.torque;
}

}  // namespace flinch
