#include "diagrams/low_latency_motion.h"

#include <algorithm>

#include "diagrams/contact_control_settings.h"
#include "diagrams/shared_parts.h"
#include "systems/model/robot_model.h"

namespace flinch {
namespace {

StageContext named(const StageContext& site, const std::string& name) {
  return {site.builder, name, site.robot, site.settings, site.shared, site.loads};
}

OutputPort<DriveTorque> add_torque_mapping(const StageContext& site, const SensedPorts& given,
                                           const std::optional<LowPassSettings>& aligned_with) {
  auto& torque =
      site.builder.add<DriveTorqueMapping>(site.name, site.robot, site.settings.drive_torque, aligned_with);
  site.builder.connect(given.joints, torque.joints);
  site.builder.connect(given.drives, torque.drives);
  site.builder.connect(given.status, torque.status);
  return torque.torque;
}

DisturbanceFilter& add_filter(const StageContext& site, const MotionPorts& given,
                              const DisturbanceFilterSettings& settings) {
  DiagramBuilder& builder = site.builder;
  auto& filter = builder.add<DisturbanceFilter>(site.name, site.robot, settings);
  builder.connect(given.joints, filter.joints);
  builder.connect(given.platform, filter.platform);
  builder.connect(given.kinematics, filter.kinematics);
  builder.connect(given.dynamics, filter.dynamics);
  builder.connect(add_present_torque(site, given), filter.torque);
  return filter;
}

MotionModel& add_model(const StageContext& site, OutputPort<PlatformMotion> motion) {
  auto& model = site.builder.add<MotionModel>("model_low_latency", site.robot);
  site.builder.connect(motion, model.platform);
  return model;
}

}  // namespace

StageContext part(const StageContext& site, const std::string& what) {
  return named(site, site.name + "_" + what);
}

std::optional<LowPassSettings> torque_low_pass(const ContactControlSettings& settings) {
  return settings.aligned_with_velocity ? std::optional(settings.velocity_filter.low_pass) : std::nullopt;
}

OutputPort<DriveTorque> add_drive_torque(const StageContext& site, const SensedPorts& given,
                                         const std::optional<LowPassSettings>& aligned_with) {
  std::vector<SharedParts::Torque>& known = site.shared.torques;
  const auto found = std::find_if(known.begin(), known.end(), [&](const SharedParts::Torque& each) {
    return each.aligned_with == aligned_with;
  });
  if (found != known.end()) return found->port;
  known.push_back({aligned_with, add_torque_mapping(site, given, aligned_with)});
  return known.back().port;
}

OutputPort<DriveTorque> add_present_torque(const StageContext& site, const SensedPorts& given) {
  return add_drive_torque(named(site, "present_torque"), given, std::nullopt);
}

DisturbanceFilter& add_encoder_filter(const StageContext& site, const MotionPorts& given,
                                      const DisturbanceFilterSettings& settings) {
  std::vector<SharedParts::Filter>& known = site.shared.filters;
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const SharedParts::Filter& each) { return each.settings == settings; });
  if (found != known.end()) return *found->filter;
  known.push_back({settings, &add_filter(site, given, settings)});
  return *known.back().filter;
}

LowLatencyPorts low_latency(const StageContext& site, const AcceleratedPorts& given) {
  const DisturbanceFilter& filter =
      add_encoder_filter(named(site, "motion_low_latency"), given, site.settings.disturbance_filter);
  LowLatencyPorts present{given, filter.wrench};
  present.platform = filter.followed;
  MotionModel*& model = site.shared.model_low_latency;
  if (model == nullptr) model = &add_model(site, present.platform);
  present.kinematics = model->kinematics;
  present.dynamics = model->dynamics;
  return present;
}

}  // namespace flinch
