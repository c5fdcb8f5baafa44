#include "diagrams/watched_imu.h"

#include "diagrams/contact_control_settings.h"

namespace flinch {

WatchedImu add_watched_imu(const StageContext& site) {
  PlausibilityLimits limits = site.settings.plausibility;
  limits.imu_mount = site.settings.imu_mount;
  limits.stamp_spread = site.settings.imu_stamp_spread;
  if (limits.torque_constant.size() == 0) limits.torque_constant = site.settings.drive_torque.torque_constant;
  return {site.builder.optional_input<ImuReading>("imu"),
          site.builder.add<PlausibilityMonitor>(site.name, site.robot, limits)};
}

}  // namespace flinch
