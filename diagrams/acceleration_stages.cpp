#include "diagrams/acceleration_stages.h"

#include "diagrams/contact_control_settings.h"

namespace flinch {
namespace {

OutputPort<PlatformAcceleration> add(const StageContext& site, const MotionPorts& given,
                                     ImuFilterSettings settings) {
  settings.mount = site.settings.imu_mount;
  settings.stamp_spread = site.settings.imu_stamp_spread;
  auto& filter = site.builder.add<ImuFilter>(site.name, site.robot, settings);
  site.builder.connect(given.platform, filter.platform);
  site.builder.connect(given.imu, filter.imu);
  return filter.acceleration;
}

OutputPort<PlatformAcceleration> add_imu_ekf(const StageContext& site, const MotionPorts& given) {
  return add(site, given, site.settings.imu_ekf);
}

OutputPort<PlatformAcceleration> add_extended_imu_ekf(const StageContext& site, const MotionPorts& given) {
  return add(site, given, site.settings.extended_imu_ekf);
}

OutputPort<PlatformAcceleration> add_unscented_imu_filter(const StageContext& site,
                                                          const MotionPorts& given) {
  return add(site, given, site.settings.unscented_imu_filter);
}

}  // namespace

std::vector<AccelerationSource> acceleration_stages() {
  return {{"imu_ekf", add_imu_ekf},
          {"extended_imu_ekf", add_extended_imu_ekf},
          {"unscented_imu_filter", add_unscented_imu_filter}};
}

}  // namespace flinch
