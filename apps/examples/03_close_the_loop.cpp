// A closed loop around your own controller: a spring holds the platform and gives way to a force F by F / K.
//
//   station -> velocity filter -> forward kinematics -> robot model -> Spring -> station
// On a real robot the torque gate stands between controller and drives: see diagrams/contact_control.h.
#include <cmath>
#include <cstdio>
#include <memory>

#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/simulator.h"
#include "systems/model/forward_kinematics.h"
#include "systems/model/robot_model.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/sensors/velocity_filter.h"

using namespace flinch;

class Spring final : public System {
 public:
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  OutputPort<TorqueCommand> torque = output<&Spring::pull>("torque", clock, kinematics);

  TorqueCommand pull(Time now, const Kinematics& at) const {
    if (!at.valid) return {};  // no pose, no torque: the drives brake
    const Eigen::Vector3d K(2000, 2000, 85), D(170, 170, 4);
    const PlatformVector F_a = -K.cwiseProduct(at.pose) - D.cwiseProduct(at.velocity);
    return {.computed = now, .valid = true, .torque = drive_torques(at, F_a)};
  }
};

int main() {
  SimulatedStationSettings settings;
  const auto robot =
      std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::simulation));
  settings.rig.robot = robot;
  settings.applied_wrench = {
      {.peak_in_base = PlatformVector{{20, 0, 0}}, .rise = 0s, .hold = 1s, .fall = 0s}};
  DiagramBuilder builder("example", 1ms);
  const SimulatedStation station = add_simulated_station(builder, settings);
  auto& velocity = builder.add<VelocityFilter>("velocity_filter", robot);
  auto& pose = builder.add<ForwardKinematics>("forward_kinematics", robot);
  auto& model = builder.add<RobotModel>("model", robot);
  auto& spring = builder.add<Spring>("spring");
  builder.connect(station.joints, velocity.joints);
  builder.connect(station.joints, pose.joints);
  builder.connect(velocity.motion, pose.motion);
  builder.connect(pose.platform, model.platform);
  builder.connect(model.kinematics, spring.kinematics);
  builder.connect(spring.torque, station.torque_command);
  const auto brake = builder.export_input("brake", station.brake);
  const auto diagram = builder.build();
  Simulator simulator(*diagram, std::make_unique<SundialsIntegrator>());
  Context context = diagram->make_context();
  context.set(brake, {.engage = false});
  simulator.advance_to(context, 990ms);
  const double pushed = context.get(station.platform_truth).pose[0];
  simulator.advance_to(context, 2s);
  const double released = context.get(station.platform_truth).pose[0];
  std::printf("pushed %.3f mm, 20 N / 2 N/mm are 10 mm; released %.3f mm\n", 1e3 * pushed, 1e3 * released);
  return std::abs(pushed - 0.010) < 2e-5 && std::abs(released) < 2e-5 ? 0 : 1;
}
