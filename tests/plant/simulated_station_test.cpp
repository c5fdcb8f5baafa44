#include "plant/simulated_station.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recorder.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/quantity_units.h"
#include "tests/plant/servoed_station.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

/// With the errors of real sensors and a pylon in the way.
SimulatedStationSettings noisy_station(std::uint64_t seed = 3) {
  SimulatedStationSettings settings;
  settings.rig.robot = test::individual_rig(RigFriction::test_rig);
  settings.rig.obstacles = {test::fixed_post(0.32, 0.20)};
  settings.drives.torque_constant = Eigen::Vector3d(6.021, 6.6116, 6.7315);
  settings.seed = seed;
  return settings;
}

/// A station whose commands the test sets.
class CommandedStation {
 public:
  explicit CommandedStation(const SimulatedStationSettings& settings)
      : station(add_simulated_station(builder_, settings)),
        command_(builder_.export_input("command", station.torque_command)),
        brake_(builder_.export_input("brake", station.brake)),
        diagram_(builder_.build()),
        context_(diagram_->make_context()),
        simulator_(*diagram_, std::make_unique<SundialsIntegrator>()) {
    context_.set(brake_, {.engage = false});
  }

  void command(const Eigen::Vector3d& torque) {
    context_.set(command_, {.computed = context_.time(), .valid = true, .torque = torque});
  }
  void step() { simulator_.step(context_); }
  template <class Port>
  const typename Port::Value& get(Port port) const {
    return context_.get(port);
  }
  Time now() const { return context_.time(); }

 private:
  DiagramBuilder builder_{"test", 1ms};

 public:
  SimulatedStation station;

 private:
  InputPort<TorqueCommand> command_;
  InputPort<BrakeCommand> brake_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
  Simulator simulator_;
};

Recording record(const SimulatedStationSettings& settings, Time duration) {
  test::ServoedStation station(settings);
  Recorder recorder(station.diagram(), recordable_paths(station.diagram()),
                    static_cast<std::size_t>(duration / 1ms),
                    quantity_units(*std::dynamic_pointer_cast<const PlanarRrr>(settings.rig.robot)));
  station.simulator().record(recorder);
  for (Time now{}; now < duration; now += 1ms) station.step();
  return recorder.recording();
}

bool same_bits(const Signal& a, const Signal& b) {
  return std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(),
                    [](internal::Number x, internal::Number y) { return x.integer == y.integer; });
}

TEST(SimulatedStation, MeetsTheContractOfAStation) {
  test::ServoedStation station(noisy_station());
  station.advance_to(20ms);
  EXPECT_TRUE(station.get(station.station.joints).valid);
  EXPECT_TRUE(station.get(station.station.joints).passive_valid);
  EXPECT_TRUE(station.get(station.station.drives).valid);
  EXPECT_TRUE(station.get(station.station.imu).valid);
  EXPECT_TRUE(station.get(station.station.status).valid);
  EXPECT_TRUE(station.get(station.station.status).enabled);
  ASSERT_TRUE(station.station.force_torque);
  EXPECT_TRUE(station.get(*station.station.force_torque).valid);
  EXPECT_EQ(station.get(station.station.joints).acquired, 20ms);
  EXPECT_EQ(station.get(station.station.drives).acquired, 20ms);
  EXPECT_EQ(station.get(station.station.imu).acquired, 16ms);
  EXPECT_EQ(station.get(*station.station.force_torque).acquired, 20ms);
}

TEST(SimulatedStation, HasNoForceTorqueSensorWithoutAPylon) {
  DiagramBuilder builder("test", 1ms);
  EXPECT_FALSE(add_simulated_station(builder, test::rig_station()).force_torque);
  SimulatedStationSettings dismounted = noisy_station();
  dismounted.force_torque.reset();
  DiagramBuilder other("test", 1ms);
  EXPECT_FALSE(add_simulated_station(other, dismounted).force_torque);
  dismounted.faults = {{.signal = FaultSignal::force_torque}};
  DiagramBuilder faulty("test", 1ms);
  EXPECT_THROW(add_simulated_station(faulty, dismounted), SetupError);
}

TEST(SimulatedStation, RefusesFaultsOfPassiveEncodersThatAreNotMounted) {
  SimulatedStationSettings settings = noisy_station();
  settings.faults = {{.signal = FaultSignal::passive_encoder}};
  DiagramBuilder mounted("test", 1ms);
  EXPECT_NO_THROW(add_simulated_station(mounted, settings));
  settings.encoders.passive_mounted = false;
  DiagramBuilder dismounted("test", 1ms);
  EXPECT_THROW(add_simulated_station(dismounted, settings), SetupError);
}

TEST(SimulatedStation, WithIdealSensorsTellsTheTruth) {
  const SimulatedStationSettings settings = with_ideal_sensors(noisy_station());
  test::ServoedStation station(settings);
  int in_contact = 0;
  for (int k = 0; k < 1000; ++k) {
    station.step();
    const PlantTruth& truth = station.truth();
    EXPECT_EQ(station.get(station.station.joints).active, truth.active);
    EXPECT_EQ(station.get(station.station.joints).passive, truth.passive);
    const JointVector torque = settings.drives.torque_constant.cwiseProduct(
        Eigen::Vector3d(station.get(station.station.drives).current));
    EXPECT_NEAR((torque - truth.drive_torque).norm(), 0.0, 1e-12);
    EXPECT_EQ(station.get(station.station.imu).acquired, truth.acquired);
    const ForceTorqueReading& force = station.get(*station.station.force_torque);
    const ContactTruth& contact = station.contact();
    const Eigen::Vector2d expected = contact.strongest.force_in_base + contact.second.force_in_base;
    EXPECT_NEAR((force.force_in_base.head<2>() - expected).norm(), 0.0, 1e-9);
    in_contact += contact.in_contact ? 1 : 0;
  }
  EXPECT_GT(in_contact, 50);
}

TEST(SimulatedStation, AllocatesNothingInATick) {
  for (const auto& post : {test::fixed_post(0.32, 0.20), test::compliant_post(0.32, 0.20)}) {
    SimulatedStationSettings settings = noisy_station();
    settings.rig.obstacles = {post};
    test::ServoedStation station(settings);
    station.step();
    const test::AllocationCounter counter;
    int in_contact = 0;
    for (int k = 0; k < 2000; ++k) {
      station.step();
      in_contact += station.contact().in_contact ? 1 : 0;
    }
    EXPECT_EQ(counter.count(), 0);
    EXPECT_GT(in_contact, 50);
    EXPECT_EQ(station.simulator().inaccurate_steps(), 0);
  }
}

TEST(SimulatedStation, RepeatsItselfBitForBit) {
  const Recording first = record(noisy_station(), 1500ms);
  const Recording again = record(noisy_station(), 1500ms);
  ASSERT_EQ(first.signals.size(), again.signals.size());
  EXPECT_GT(first.signals.size(), 10U);
  for (std::size_t i = 0; i < first.signals.size(); ++i) {
    EXPECT_TRUE(same_bits(first.signals[i], again.signals[i])) << first.signals[i].path;
  }
}

TEST(SimulatedStation, GoesOnFromACopiedContextAsTheOriginalDoes) {
  test::ServoedStation station(noisy_station());
  station.advance_to(700ms);
  Context copy = station.context();
  station.advance_to(1200ms);
  const PlantTruth original = station.truth();
  const ImuReading original_imu = station.get(station.station.imu);
  Simulator fresh(station.diagram(), std::make_unique<SundialsIntegrator>());
  fresh.advance_to(copy, 1200ms);
  EXPECT_EQ(copy.get(station.station.plant_truth).pose, original.pose);
  EXPECT_EQ(copy.get(station.station.plant_truth).velocity, original.velocity);
  EXPECT_EQ(copy.get(station.station.imu).specific_force, original_imu.specific_force);
}

TEST(SimulatedStation, SeedsChangeTheSensorsNotTheRobot) {
  const Recording first = record(noisy_station(1), 300ms);
  const Recording other = record(noisy_station(2), 300ms);
  EXPECT_TRUE(same_bits(first.signal("station/truth"), other.signal("station/truth")));
  for (const char* sensor : {"station/joints", "station/drives", "station/imu", "station/force_torque"}) {
    EXPECT_FALSE(same_bits(first.signal(sensor), other.signal(sensor))) << sensor;
  }
}

TEST(SimulatedStation, BrakesWhenCommandsStopComing) {
  CommandedStation station(with_ideal_sensors(noisy_station()));
  for (int k = 0; k < 100; ++k) {
    station.command({4.0, -1.0, -3.0});
    station.step();
  }
  const Time last_command = station.now() - 1ms;
  EXPECT_FALSE(station.get(station.station.status).braked);
  EXPECT_GT(station.get(station.station.plant_truth).velocity.norm(), 0.1);
  while (!station.get(station.station.status).braked) {
    station.step();
    ASSERT_LT(station.now(), last_command + 10ms);
  }
  // The first tick that refuses the command is the one at which it is 4 ms old; the next one sees the brakes
  // closed.
  EXPECT_EQ(station.get(station.station.status).acquired, last_command + 5ms);
  EXPECT_EQ(station.get(station.station.plant_truth).drive_torque, JointVector::Zero(3));
  for (int k = 0; k < 100; ++k) station.step();
  EXPECT_LT(station.get(station.station.plant_truth).velocity.norm(), 1e-3);
}

TEST(SimulatedStation, HoldsTheTorqueOfATickUntilTheNext) {
  CommandedStation station(test::rig_station());
  station.command({1.0, 2.0, 3.0});
  station.step();
  EXPECT_EQ(station.get(station.station.plant_truth).drive_torque, JointVector::Zero(3))
      << "seen at this tick";
  station.command({-1.0, 0.0, 0.0});
  station.step();
  EXPECT_TRUE(station.get(station.station.plant_truth).drive_torque.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0)));
  EXPECT_TRUE(station.get(station.station.drives)
                  .current.isApprox(Eigen::Vector3d(1.0 / 6.021, 2.0 / 6.6116, 3.0 / 6.7315)));
}

TEST(SimulatedStation, YieldsToAnAppliedWrenchAsStifflyAsItIsHeld) {
  SimulatedStationSettings settings = test::rig_station();
  settings.rig.robot = test::individual_rig();
  settings.applied_wrench = {{.peak_in_base = PlatformVector{{40.0, 0.0, 0.0}},
                              .start = 100ms,
                              .rise = 2s,
                              .hold = 500ms,
                              .fall = 2s}};
  test::ServoedStation station(settings, {.amplitude = {0.0, 0.0, 0.0}});
  station.advance_to(2500ms);
  EXPECT_NEAR(station.truth().pose[0], 40.0 / 2000.0, 1e-4) << "stiffness 2 N/mm";
  EXPECT_NEAR(station.truth().wrench_in_base[0], 40.0, 1e-12);
  station.advance_to(5500ms);
  EXPECT_NEAR(station.truth().pose[0], 0.0, 1e-4);
}

TEST(SimulatedStation, FromDataThatDescribesNoBenchIsRefused) {
  DiagramBuilder builder("test", 1ms);
  EXPECT_THROW(add_simulated_station(builder, SimulatedStationSettings{}), SetupError);
}

}  // namespace
}  // namespace flinch
