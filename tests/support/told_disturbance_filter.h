#pragma once

#include <memory>
#include <utility>

#include "systems/estimators/disturbance_filter.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch::test {

/// The disturbance filter of the planar rig, which is told by hand what it is given.
class ToldDisturbanceFilter {
 public:
  explicit ToldDisturbanceFilter(std::shared_ptr<const PlanarRrr> robot)
      : filter_(builder_.add<DisturbanceFilter>("filter", std::move(robot), DisturbanceFilterSettings{})) {}

  Time now() const { return ticking_.now(); }
  void tick(const Posture& posture, const JointVector& torque, bool braked = false) {
    ticking_.set(joints_, posture.joints);
    ticking_.set(platform_, posture.platform);
    ticking_.set(kinematics_, posture.kinematics);
    ticking_.set(dynamics_, posture.dynamics);
    ticking_.set(torque_, DriveTorque{ticking_.now(), true, torque, braked});
    ticking_.tick();
  }
  const WrenchEstimate& wrench() const { return ticking_.get(filter_.wrench); }
  const PlatformMotion& followed() const { return ticking_.get(filter_.followed); }

 private:
  DiagramBuilder builder_{"robot", 1ms};
  DisturbanceFilter& filter_;
  InputPort<JointReading> joints_ = builder_.export_input("joints", filter_.joints);
  InputPort<PlatformMotion> platform_ = builder_.export_input("platform", filter_.platform);
  InputPort<Kinematics> kinematics_ = builder_.export_input("kinematics", filter_.kinematics);
  InputPort<Dynamics> dynamics_ = builder_.export_input("dynamics", filter_.dynamics);
  InputPort<DriveTorque> torque_ = builder_.export_input("torque", filter_.torque);
  Ticking ticking_{builder_};
};

}  // namespace flinch::test
