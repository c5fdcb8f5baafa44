#include "plant/simulated_base_forces.h"

#include <gtest/gtest.h>

#include <memory>

#include "systems/foundation/setup_error.h"
#include "systems/robot/leg_bases.h"
#include "tests/plant/moving_rig.h"
#include "tests/plant/rig_scene.h"
#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

struct Sensors {
  Sensors(const std::shared_ptr<const PlanarRrr>& robot, double noise)
      : block(builder.add<SimulatedBaseForces>(
            "sensors",
            SimulatedBaseForcesSettings{.bases = leg_bases(robot, JointVector::Constant(3, 1.1), *robot),
                                        .ideal = noise == 0.0,
                                        .noise = noise},
            robot, 5U)),
        snapshot(builder.export_input("snapshot", block.snapshot)),
        ticking(builder) {}

  BaseForceReading see(const RigSnapshot& rig) {
    ticking.set(snapshot, rig);
    ticking.tick();
    return ticking.get(block.forces);
  }

  DiagramBuilder builder{"test", 1ms};
  SimulatedBaseForces& block;
  InputPort<RigSnapshot> snapshot;
  test::Ticking ticking;
};

TEST(SimulatedBaseForces, SumUpToWhatAPostDoesToARobotThatRests) {
  const auto robot = test::individual_rig();
  RigSettings settings;
  settings.robot = robot;
  settings.link_material.reset();
  settings.obstacles = {test::fixed_post(0.16, 0.0, {.stiffness = 2000.0, .restitution = 0.2})};
  test::MovingRig rig(settings);
  rig.equation.drives.braked = true;
  for (int k = 0; k < 1500; ++k) rig.tick();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (int i = 0; i < rig.now.contacts.touch_count; ++i)
    force += rig.now.contacts.touches[static_cast<std::size_t>(i)].force_on_robot;
  ASSERT_GT(force.norm(), 5.0);
  Sensors sensors(robot, 0.0);
  const BaseForceReading reading = sensors.see(rig.now);
  ASSERT_TRUE(reading.valid);
  const BaseForces& borne = reading.force_in_base;
  const Eigen::Vector2d sum = borne.segment<2>(0) + borne.segment<2>(2) + borne.segment<2>(4);
  EXPECT_LT((sum + force.head<2>()).norm(), 1e-3 * force.norm());
}

TEST(SimulatedBaseForces, AskForTheBaseJointsOfTheirRobot) {
  EXPECT_THROW(SimulatedBaseForces({}, test::individual_rig(), 1U), SetupError);
}

TEST(SimulatedBaseForces, HaveNoiseAndNoDataWhereTheRobotHasComeApart) {
  const auto robot = test::individual_rig();
  RigSettings settings;
  settings.robot = robot;
  test::MovingRig rig(settings);
  Sensors sensors(robot, 0.2);
  test::Statistics statistics;
  for (int k = 0; k < 2000; ++k) statistics.add(sensors.see(rig.now).force_in_base[k % 6]);
  EXPECT_NEAR(statistics.deviation(), 0.2, 0.02);
  RigSnapshot apart = rig.now;
  apart.reachable = false;
  EXPECT_FALSE(sensors.see(apart).valid);
}

}  // namespace
}  // namespace flinch
