#include "plant/simulated_current_sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

/// Sensors of drives that act with constant currents.
class Currents {
 public:
  explicit Currents(const SimulatedCurrentSensorsSettings& settings, std::uint64_t seed = 1)
      : ticking_(wire(settings, seed)) {
    ticking_.set(drives_, {.torque = {}, .current = current, .enabled = true, .braked = false});
  }

  DriveReading read() {
    ticking_.tick();
    return ticking_.get(currents_);
  }

  const Eigen::Vector3d current{1.0, -2.0, 0.3};

 private:
  DiagramBuilder& wire(const SimulatedCurrentSensorsSettings& settings, std::uint64_t seed) {
    auto& sensors = builder_.add<SimulatedCurrentSensors>("sensors", settings, 3, seed);
    drives_ = builder_.export_input("drives", sensors.drives);
    currents_ = sensors.currents;
    return builder_;
  }

  DiagramBuilder builder_{"test", 1ms};
  InputPort<DriveAction> drives_;
  OutputPort<DriveReading> currents_;
  test::Ticking ticking_;
};

TEST(SimulatedCurrentSensors, IdealOnesTellTheTruth) {
  Currents sensors({.ideal = true});
  sensors.read();
  const DriveReading reading = sensors.read();
  EXPECT_TRUE(reading.valid);
  EXPECT_EQ(reading.acquired, 1ms);
  EXPECT_EQ(reading.current, sensors.current);
}

TEST(SimulatedCurrentSensors, NoiseHasTheGivenDeviation) {
  Currents sensors({.noise = 0.05});
  test::Statistics noise;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) noise.add(sensors.read().current[1] - sensors.current[1]);
  EXPECT_NEAR(noise.mean(), 0.0, 4.0 * 0.05 / std::sqrt(samples));
  EXPECT_NEAR(noise.deviation(), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * samples));
}

TEST(SimulatedCurrentSensors, QuantiseWhereAsked) {
  Currents sensors({.resolution = 0.01});
  for (int k = 0; k < 100; ++k) {
    const double steps = sensors.read().current[0] / 0.01;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
}

TEST(SimulatedCurrentSensors, AreTheSameForTheSameSeedOnly) {
  Currents a({}, 5);
  Currents b({}, 5);
  Currents c({}, 6);
  for (int k = 0; k < 10; ++k) {
    const DriveReading reading = a.read();
    EXPECT_EQ(reading.current, b.read().current);
    EXPECT_NE(reading.current, c.read().current);
  }
}

}  // namespace
}  // namespace flinch
