#include <cstdio>
#include <memory>

#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

/// Simulates the rig with its brakes closed and checks that it stays at home.
int main() {
  using namespace flinch;
  SimulatedStationSettings settings;
  const auto robot =
      std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  settings.rig.robot = robot;

  DiagramBuilder builder;
  const SimulatedStation station = add_simulated_station(builder, settings);
  const auto torque = builder.export_input("torque_command", station.torque_command);
  const auto brake = builder.export_input("brake", station.brake);
  const auto diagram = builder.build();

  Context context = diagram->make_context();
  context.set(torque, TorqueCommand{});
  context.set(brake, BrakeCommand{.engage = true});
  Simulator(*diagram, std::make_unique<SundialsIntegrator>()).advance_to(context, 50ms);

  const PlatformMotion& found = context.get(station.platform_truth);
  const double way = robot->difference(found.pose, robot->home_pose()).norm();
  std::printf("behind closed brakes the platform moved by %.1e\n", way);
  return found.valid() && way < 1e-6 ? 0 : 1;
}
