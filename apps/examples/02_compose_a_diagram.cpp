// Blocks wired into a diagram: from the encoders of a simulated robot to the pose of its platform.
//
//   station.joints -> velocity filter -> forward kinematics -> pose
//
// The brakes are open and a push moves the platform. Forward kinematics sees nothing but noisy encoders; what
// it finds is recorded beside the truth. Their difference, seen by the drives, must be the encoders' noise.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/model/forward_kinematics.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/quantity_units.h"
#include "systems/sensors/velocity_filter.h"

int main() {
  using namespace flinch;
  SimulatedStationSettings settings;
  const auto robot =
      std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  settings.rig.robot = robot;
  settings.applied_wrench = {
      {.peak_in_base = PlatformVector{{20, 10, 1}}, .start = 50ms, .rise = 50ms, .fall = 50ms}};

  DiagramBuilder builder("example", 1ms);
  const SimulatedStation station = add_simulated_station(builder, settings);
  auto& velocity = builder.add<VelocityFilter>("velocity_filter", robot);
  auto& pose = builder.add<ForwardKinematics>("forward_kinematics", robot);
  builder.connect(station.joints, velocity.joints);
  builder.connect(station.joints, pose.joints);
  builder.connect(velocity.motion, pose.motion);
  const auto torque = builder.export_input("torque_command", station.torque_command);
  const auto brake = builder.export_input("brake", station.brake);
  const auto diagram = builder.build();  // throws, naming every input that is not connected

  constexpr int ticks = 400;
  Recorder recorder(*diagram, {"forward_kinematics/platform", "station/platform_truth"}, ticks,
                    quantity_units(*robot));
  Simulator simulator(*diagram, std::make_unique<SundialsIntegrator>());
  simulator.record(recorder);
  Context context = diagram->make_context();
  context.set(brake, {.engage = false});
  double sum = 0.0;
  for (int tick = 0; tick < ticks; ++tick) {  // what comes from outside is set before the tick
    context.set(torque, {.computed = context.time(), .valid = true, .torque = JointVector::Zero(3)});
    simulator.step(context);
    const PlatformMotion& truth = context.get(station.platform_truth);
    Kinematics kinematics;
    robot->kinematics(truth.pose, truth.velocity, kinematics);
    const PlatformVector miss = robot->difference(context.get(pose.platform).pose, truth.pose);
    if (tick > 0) sum += (kinematics.J_qa_x * miss).squaredNorm();  // a velocity needs two samples
  }
  std::filesystem::create_directories("out");
  write_recording(recorder.recording(), "out/example_02.h5");
  const double noise = settings.encoders.active.noise, error = std::sqrt(sum / (3 * (ticks - 1)));
  const double way = context.get(station.platform_truth).pose.head(2).norm();
  std::printf("%.0f mm away, error %.1e rad at the drives, noise %.1e rad\n", 1e3 * way, error, noise);
  return way > 0.02 && std::abs(error / noise - 1.0) < 0.1 ? 0 : 1;
}
