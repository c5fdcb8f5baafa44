#include "diagrams/safety_filtering.h"

#include "diagrams/contact_control_settings.h"
#include "diagrams/low_latency_motion.h"
#include "systems/framework/constant.h"
#include "systems/laws/braking_monitor.h"
#include "systems/laws/gated_motion.h"
#include "systems/laws/safety_filter.h"
#include "systems/model/robot_model.h"
#include "systems/safety/stopping_motion.h"

namespace flinch {
namespace {

/// A safety filter with a model of its own: it is evaluated in the ticks in which there is a motion.
SafetyFilter& add_filter(const StageContext& site, OutputPort<PlatformMotion> motion,
                         OutputPort<WrenchEstimate> disturbance, OutputPort<TorqueCommand> requested) {
  DiagramBuilder& builder = site.builder;
  auto& model = builder.add<MotionModel>(site.name + "_model", site.robot);
  auto& safety_filter = builder.add<SafetyFilter>(site.name, site.robot, site.settings.limits);
  builder.connect(motion, model.platform);
  builder.connect(motion, safety_filter.motion);
  builder.connect(model.kinematics, safety_filter.kinematics);
  builder.connect(model.dynamics, safety_filter.dynamics);
  builder.connect(disturbance, safety_filter.disturbance);
  builder.connect(requested, safety_filter.request);
  return safety_filter;
}

OutputPort<BrakingStatus> add_braking_monitor(const StageContext& site, OutputPort<PlatformMotion> motion,
                                              OutputPort<ReactionState> reaction) {
  const SafetyFilterSettings& kept = site.settings.limits;
  auto& watch = site.builder.add<BrakingMonitor>("braking", site.robot, kept.limits,
                                                 planned_torque_share * kept.max_torque);
  site.builder.connect(motion, watch.motion);
  site.builder.connect(reaction, watch.reaction);
  return watch.status;
}

}  // namespace

LimitedTorques add_safety_filter(const StageContext& site, const ReactionPorts& given,
                                 OutputPort<TorqueCommand> requested) {
  DiagramBuilder& builder = site.builder;
  if (site.settings.limits.use == SafetyFilterSettings::Use::never)
    return {requested, builder.add<Constant<LimitStatus>>(site.name, LimitStatus()).value,
            builder.add<Constant<BrakingStatus>>("braking", BrakingStatus()).value};
  DisturbanceFilter& filter = add_encoder_filter(part(site, "motion"), given, site.settings.limits_filter);
  auto& kept = builder.add<GatedMotion>(site.name + "_gated_motion", site.settings.limits.use);
  builder.connect(filter.followed, kept.motion);
  builder.connect(given.reaction, kept.reaction);
  SafetyFilter& safety_filter = add_filter(site, kept.kept, filter.wrench, requested);
  return {safety_filter.torque, safety_filter.status,
          add_braking_monitor(site, filter.followed, given.reaction), safety_filter.commanded,
          FollowedMotion{filter.followed, filter.wrench}};
}

OutputPort<TorqueCommand> add_kept_stop(const StageContext& site, const FollowedMotion& followed,
                                        const StopPorts& stop) {
  DiagramBuilder& builder = site.builder;
  auto& motion = builder.add<StoppingMotion>(site.name + "_motion");
  builder.connect(followed.platform, motion.motion);
  builder.connect(stop.faults, motion.faults);
  builder.connect(stop.gate, motion.gate);
  SafetyFilter& safety_filter = add_filter(site, motion.trusted, followed.disturbance, stop.torque);
  builder.connect(stop.commanded, safety_filter.commanded);
  return safety_filter.torque;
}

}  // namespace flinch
