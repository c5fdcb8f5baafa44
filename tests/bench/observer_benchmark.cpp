// What each block from the encoders to the detected contact costs in a tick, and what they cost together.
// Every number contains the setting of the block's inputs and one tick of a diagram that holds nothing else.
#include <benchmark/benchmark.h>

#include <optional>

#include "systems/contact/contact_detector.h"
#include "systems/estimators/momentum_observer.h"
#include "systems/model/forward_kinematics.h"
#include "systems/model/robot_model.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/sensors/drive_torque_mapping.h"
#include "systems/sensors/velocity_filter.h"
#include "tests/support/smooth_trajectory.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using test::Ticking;

/// What comes from outside at one instant of the motion, and what blocks hand on; without the model, so that
/// reading it from memory takes no longer than the blocks.
struct Instant {
  JointReading joints;
  JointMotion motion;
  DriveReading drives;
  DriveTorque torque;
  PlatformMotion platform;
};

struct Model {
  Kinematics kinematics;
  Dynamics dynamics;
};

std::shared_ptr<const PlanarRrr> bench() {
  static const auto robot =
      std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  return robot;
}

Model model_at(const test::SmoothTrajectory& truth) {
  Model model;
  bench()->kinematics(truth.pose, truth.velocity, model.kinematics);
  bench()->dynamics(model.kinematics, model.dynamics);
  return model;
}

/// Ten seconds of the smooth trajectory, after which it repeats.
const std::vector<Instant>& instants() {
  static const std::vector<Instant> all = [] {
    std::vector<Instant> made(10'000);
    for (std::size_t k = 0; k < made.size(); ++k) {
      Instant& now = made[k];
      const test::SmoothTrajectory truth(1e-3 * static_cast<double>(k));
      const auto [kinematics, dynamics] = model_at(truth);
      const auto& [active, passive, coupling] = kinematics.joints;
      const PlatformVector F_a = dynamics.M_x * PlatformVector(truth.acceleration);
      now.joints = {{}, true, true, active, passive};
      now.motion = {{}, true, active, kinematics.rates.active};
      now.platform = {{}, PlatformMotion::Status::valid, truth.pose, truth.velocity};
      now.torque = {{}, true, drive_torques(kinematics, F_a)};
      now.drives = {{}, true, now.torque.torque};
    }
    return made;
  }();
  return all;
}

/// Sets an input to a value acquired now.
template <class T>
void show(Ticking& ticking, InputPort<T> input, T value) {
  value.acquired = ticking.now();
  ticking.set(input, value);
}

/// Ticks along the motion; `set` gives the inputs of each instant.
template <class Set>
void run(benchmark::State& state, Ticking& ticking, Set set) {
  const std::vector<Instant>& all = instants();
  std::size_t k = 0;
  const auto tick = [&] {
    set(all[k]);
    ticking.tick();
    if (++k == all.size()) k = 0;
  };
  tick();  // of which nothing is valid yet: a velocity needs two
  for (auto unused : state) tick();
}

DriveTorqueMapping& add_drive_torque(DiagramBuilder& builder, const char* name, bool aligned) {
  return builder.add<DriveTorqueMapping>(name, bench(), DriveTorqueSettings{JointVector::Ones(3), {}},
                                         aligned ? std::optional(LowPassSettings{}) : std::nullopt);
}

MomentumObserverSettings observer_settings() {
  return {PlatformVector::Constant(3, 20.0), TorqueTiming::sampled, {}};
}

void VelocityFilterTick(benchmark::State& state) {
  DiagramBuilder builder;
  auto& block = builder.add<VelocityFilter>("block", bench());
  const auto joints = builder.export_input("joints", block.joints);
  Ticking ticking(builder);
  run(state, ticking, [&](const Instant& now) { show(ticking, joints, now.joints); });
}
BENCHMARK(VelocityFilterTick);

void ForwardKinematicsTick(benchmark::State& state) {
  DiagramBuilder builder;
  ForwardKinematicsSettings settings;
  settings.start = static_cast<ForwardKinematicsStart>(state.range(0));
  auto& block = builder.add<ForwardKinematics>("block", bench(), settings);
  const auto motion = builder.export_input("motion", block.motion);
  const auto joints = builder.export_input("joints", block.joints);
  Ticking ticking(builder);
  run(state, ticking, [&](const Instant& now) {
    show(ticking, motion, now.motion);
    show(ticking, joints, now.joints);
  });
  if (!ticking.get(block.platform).valid()) state.SkipWithError("no pose");
}
BENCHMARK(ForwardKinematicsTick)
    ->ArgName("from_passive_angles")
    ->Arg(static_cast<int>(ForwardKinematicsStart::previous_pose))
    ->Arg(static_cast<int>(ForwardKinematicsStart::passive_angles));

void RobotModelTick(benchmark::State& state) {
  DiagramBuilder builder;
  auto& block = builder.add<RobotModel>("block", bench());
  const auto platform = builder.export_input("platform", block.platform);
  Ticking ticking(builder);
  run(state, ticking, [&](const Instant& now) { show(ticking, platform, now.platform); });
}
BENCHMARK(RobotModelTick);

void DriveTorqueMappingTick(benchmark::State& state) {
  DiagramBuilder builder;
  auto& block = add_drive_torque(builder, "block", state.range(0) != 0);
  builder.connect(builder.optional_input<JointReading>("encoders"), block.joints);
  builder.connect(builder.optional_input<StationStatus>("brakes"), block.status);
  const auto drives = builder.export_input("drives", block.drives);
  Ticking ticking(builder);
  run(state, ticking, [&](const Instant& now) { show(ticking, drives, now.drives); });
}
BENCHMARK(DriveTorqueMappingTick)->ArgName("aligned")->Arg(0)->Arg(1);

void MomentumObserverTick(benchmark::State& state) {
  DiagramBuilder builder;
  auto& block = builder.add<MomentumObserver>("block", bench(), observer_settings());
  const auto platform = builder.export_input("platform", block.platform);
  const auto kinematics = builder.export_input("kinematics", block.kinematics);
  const auto dynamics = builder.export_input("dynamics", block.dynamics);
  const auto torque = builder.export_input("torque", block.torque);
  Ticking ticking(builder);
  const Model first = model_at(test::SmoothTrajectory(0.0));
  ticking.set(kinematics, first.kinematics);  // large, and handed on by reference in a real diagram
  ticking.set(dynamics, first.dynamics);
  run(state, ticking, [&](const Instant& now) {
    show(ticking, platform, now.platform);
    show(ticking, torque, now.torque);
  });
}
BENCHMARK(MomentumObserverTick);

void ContactDetectorTick(benchmark::State& state) {
  DiagramBuilder builder;
  auto& block = builder.add<ContactDetector>("block", bench());
  const auto wrench = builder.export_input("wrench", block.wrench);
  builder.export_input("reset", block.reset);
  Ticking ticking(builder);
  run(state, ticking, [&](const Instant& now) {
    show(ticking, wrench, WrenchEstimate{{}, true, now.platform.pose, now.torque.torque});
  });
}
BENCHMARK(ContactDetectorTick);

/// From encoders and currents to the detection.
void WholeChainTick(benchmark::State& state) {
  DiagramBuilder builder;
  auto& velocity = builder.add<VelocityFilter>("velocity", bench());
  auto& pose = builder.add<ForwardKinematics>("pose", bench());
  auto& model = builder.add<RobotModel>("model", bench());
  auto& torque = add_drive_torque(builder, "torque", true);
  builder.connect(builder.optional_input<JointReading>("encoders"), torque.joints);
  builder.connect(builder.optional_input<StationStatus>("brakes"), torque.status);
  auto& observer = builder.add<MomentumObserver>("observer", bench(), observer_settings());
  auto& detector = builder.add<ContactDetector>("detector", bench());
  const auto joints = builder.input<JointReading>("joints");
  const auto drives = builder.export_input("drives", torque.drives);
  builder.export_input("reset", detector.reset);
  builder.connect(joints, velocity.joints);
  builder.connect(joints, pose.joints);
  builder.connect(velocity.motion, pose.motion);
  builder.connect(pose.platform, model.platform);
  builder.connect(pose.platform, observer.platform);
  builder.connect(model.kinematics, observer.kinematics);
  builder.connect(model.dynamics, observer.dynamics);
  builder.connect(torque.torque, observer.torque);
  builder.connect(observer.wrench, detector.wrench);
  Ticking ticking(builder);
  run(state, ticking, [&](const Instant& now) {
    show(ticking, joints, now.joints);
    show(ticking, drives, now.drives);
  });
  if (!ticking.get(pose.platform).valid()) state.SkipWithError("no pose");
}
BENCHMARK(WholeChainTick);

}  // namespace
}  // namespace flinch
