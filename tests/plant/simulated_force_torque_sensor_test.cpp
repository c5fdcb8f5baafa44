#include "plant/simulated_force_torque_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/foundation/setup_error.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

const Eigen::Vector3d pylon_in_base(0.3, 0.2, 0.0);

/// A sensor below a pylon that touches as the test says.
class Sensor {
 public:
  explicit Sensor(const SimulatedForceTorqueSettings& settings, std::uint64_t seed = 1)
      : ticking_(wire(settings, seed)) {}

  ForceTorqueReading read(const RigSnapshot& rig) {
    ticking_.set(snapshot_, rig);
    ticking_.tick();
    return ticking_.get(reading_);
  }

 private:
  DiagramBuilder& wire(const SimulatedForceTorqueSettings& settings, std::uint64_t seed) {
    auto& sensor = builder_.add<SimulatedForceTorqueSensor>("sensor", settings, pylon_in_base, seed);
    snapshot_ = builder_.export_input("snapshot", sensor.snapshot);
    reading_ = sensor.force_torque;
    return builder_;
  }

  DiagramBuilder builder_{"test", 1ms};
  InputPort<RigSnapshot> snapshot_;
  OutputPort<ForceTorqueReading> reading_;
  test::Ticking ticking_;
};

RigSnapshot touched_at(const Eigen::Vector3d& point, const Eigen::Vector3d& force_on_robot) {
  RigSnapshot rig;
  rig.reachable = true;
  rig.contacts.touch_count = 1;
  rig.obstacle_count = 1;
  rig.contacts.touches[0] = {0, 0, point, force_on_robot, 0.0, false};
  rig.force_on_mount[0] = -force_on_robot;
  return rig;
}

TEST(SimulatedForceTorqueSensor, IdealOneReadsTheForceOnTheRobotAndItsMoment) {
  Sensor sensor({.ideal = true, .depth = 0.1});
  const Eigen::Vector3d arm(0.0, 0.04, 0.0);
  const ForceTorqueReading reading = sensor.read(touched_at(pylon_in_base + arm, {5.0, 30.0, 0.0}));
  EXPECT_TRUE(reading.valid);
  EXPECT_EQ(reading.acquired, 0ms);
  const Eigen::Vector3d force(5.0, 30.0, 0.0);
  const Eigen::Vector3d from_sensor(arm.x(), arm.y(), 0.1);
  EXPECT_EQ(reading.force_in_base, force);
  EXPECT_TRUE(reading.moment_in_base.isApprox(from_sensor.cross(force)));
}

TEST(SimulatedForceTorqueSensor, NoiseHasTheGivenDeviations) {
  Sensor sensor({.force_noise = 0.2, .moment_noise = 0.01});
  const RigSnapshot untouched = touched_at(pylon_in_base, {0.0, 0.0, 0.0});
  test::Statistics force;
  test::Statistics moment;
  for (int k = 0; k < 20000; ++k) {
    const ForceTorqueReading reading = sensor.read(untouched);
    force.add(reading.force_in_base.y());
    moment.add(reading.moment_in_base.x());
  }
  EXPECT_NEAR(force.deviation(), 0.2, 0.006);
  EXPECT_NEAR(moment.deviation(), 0.01, 0.0003);
  EXPECT_NEAR(force.mean(), 0.0, 0.006);
}

TEST(SimulatedForceTorqueSensor, DeliversLateWithTheTimeOfMeasurement) {
  SimulatedForceTorqueSettings settings{.force_noise = 0.0, .moment_noise = 0.0};
  settings.delay = 2ms;
  Sensor sensor(settings);
  for (int k = 0; k < 20; ++k) {
    const ForceTorqueReading reading = sensor.read(touched_at(pylon_in_base, {1.0 * k, 0.0, 0.0}));
    EXPECT_EQ(reading.valid, k >= 2);
    if (k < 2) continue;
    EXPECT_EQ(reading.acquired, 1ms * (k - 2));
    EXPECT_EQ(reading.force_in_base.x(), k - 2.0);
  }
}

TEST(SimulatedForceTorqueSensor, OfABenchThatCameApartIsNotValid) {
  RigSnapshot broken = touched_at(pylon_in_base, {1.0, 1.0, 0.0});
  broken.reachable = false;
  EXPECT_FALSE(Sensor({}).read(broken).valid);
}

TEST(SimulatedForceTorqueSensor, RefusesADelayLongerThanItsMemory) {
  SimulatedForceTorqueSettings settings;
  settings.delay = 1s;
  EXPECT_THROW(SimulatedForceTorqueSensor(settings, pylon_in_base, 1), SetupError);
  settings.delay = -1ms;
  EXPECT_EQ(problems(settings).size(), 1U);
}

}  // namespace
}  // namespace flinch
