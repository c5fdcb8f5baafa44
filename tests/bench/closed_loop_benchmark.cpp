// A simulated millisecond of the whole closed loop (plant, contact, sensors, control path, and the recorder
// of what `flinch run` records) against MuJoCo's bare physics of the same robot: one step of its RK4 at 1 ms,
// without sensors, control, contact or recording. Both are timed in turn in the same run; `over_mujoco` is
// the ratio of the processor times.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include "experiments/recorded/recorded_signals.h"
#include "experiments/scenario/robot_files.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/config/config_node.h"
#include "systems/config/yaml_text.h"
#include "systems/framework/recorder.h"
#include "systems/framework/recording_stream.h"
#include "systems/framework/simulator.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/quantity_units.h"
#include "tests/support/processor_time.h"
#ifdef FLINCH_HAS_MUJOCO
#include "tests/peer/mujoco_rig.h"
#endif

namespace flinch {
namespace {

using Seconds = std::chrono::duration<double>;
constexpr int ticks_in_turn = 100;

const std::string apps = std::string(FLINCH_SOURCE_DIR) + "/apps/";

SimulatedScenario shipped(const std::string& name) {
  return read_simulated_scenario(apps + "scenarios/" + name + ".yaml");
}

/// The same where the fused detector is followed, with the thresholds that ship.
SimulatedScenario with_fused_detector(const std::string& name) {
  const std::filesystem::path file = apps + "scenarios/" + name + ".yaml";
  auto root = parse_yaml(shipped(name).text, file);
  root = with_value(*root, "control.detectors", parse_yaml("[fused_detector]", file));
  root =
      with_value(*root, "calibrations", parse_yaml("[{file: ../calibrations/bench_thresholds.yaml}]", file));
  RobotFiles robots;
  return parse_simulated_scenario(root, file, robots);
}

/// A scenario that starts over and over again.
class ClosedLoop {
 public:
  explicit ClosedLoop(SimulatedScenario scenario)
      : scenario_(std::move(scenario)),
        experiment_(build_experiment(scenario_)),
        recorder_(*experiment_.diagram, recorded_paths(*experiment_.diagram), RecordingStream::ring,
                  quantity_units(*scenario_.robot.robot)),
        simulator_(*experiment_.diagram, std::make_unique<SundialsIntegrator>()),
        start_(experiment_.diagram->make_context()),
        context_(start_) {
    simulator_.record(recorder_);
  }

  void tick() {
    if (context_.time() >= scenario_.duration) {
      context_ = start_;
      recorder_.clear();
    }
    simulator_.step(context_);
    if (recorder_.samples() == recorder_.capacity()) recorder_.clear();  // as who writes them to a file
  }

 private:
  SimulatedScenario scenario_;
  Experiment experiment_;
  Recorder recorder_;
  Simulator simulator_;
  Context start_;
  Context context_;
};

#ifdef FLINCH_HAS_MUJOCO
/// MuJoCo's model of the bench, swinging freely from a moving start.
class FreeRig {
 public:
  FreeRig() : mujoco_(parameters(), rig_link1(), rig_link2()) {
    mujoco_.model()->opt.tolerance =
        1e-8;  // MuJoCo's own defaults, not those of the comparison of accelerations
    mujoco_.model()->opt.iterations = 100;
    restart();
  }

  void tick() {
    if (++ticks_ % 200 == 0) restart();
    mj_step(mujoco_.model(), mujoco_.data());
  }

 private:
  static PlanarRrrParameters parameters() { return rig_robot(RigGeometry::nominal, RigFriction::simulation); }

  void restart() {
    const Eigen::Vector3d pose(0.0, 0.0, 0.0), velocity(0.3, 0.2, 0.5);
    Kinematics at;
    PlanarRrr(parameters()).kinematics(pose, velocity, at);
    const auto three = [](const JointVector& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
    mj_resetData(mujoco_.model(), mujoco_.data());
    mujoco_.set_state(pose, velocity, three(at.joints.active), three(at.joints.passive),
                      three(at.rates.active), three(at.rates.passive));
  }

  peer::MujocoRig mujoco_;
  int ticks_ = 0;
};
#endif

template <class System>
Seconds time_ticks(System& system) {
  const Seconds start = test::processor_time();
  for (int i = 0; i < ticks_in_turn; ++i) system.tick();
  return test::processor_time() - start;
}

void ClosedLoopMillisecond(benchmark::State& state, SimulatedScenario (*scenario)(const std::string&),
                           const std::string& name) {
  ClosedLoop loop(scenario(name));
  Seconds ours{}, worst{};
#ifdef FLINCH_HAS_MUJOCO
  FreeRig bench;
  Seconds theirs{};
#endif
  for (auto unused : state) {
    const Seconds turn = time_ticks(loop);
    state.SetIterationTime(turn.count());
    ours += turn;
    worst = std::max(worst, turn);
#ifdef FLINCH_HAS_MUJOCO
    theirs += time_ticks(bench);
#endif
  }
  const double ticks = ticks_in_turn * static_cast<double>(state.iterations());
  state.counters["us_per_ms"] = 1e6 * ours.count() / ticks;
  state.counters["worst_turn_us_per_ms"] = 1e6 * worst.count() / ticks_in_turn;
#ifdef FLINCH_HAS_MUJOCO
  state.counters["mujoco_us_per_ms"] = 1e6 * theirs.count() / ticks;
  state.counters["over_mujoco"] = ours / theirs;
#endif
}

void closed_loop(const char* row, SimulatedScenario (*scenario)(const std::string&), const char* name) {
  benchmark::RegisterBenchmark((std::string("ClosedLoopMillisecond/") + row).c_str(), ClosedLoopMillisecond,
                               scenario, name)
      ->UseManualTime();
}

const bool registered = [] {
  closed_loop("square", shipped, "square");
  closed_loop("square_by_fused_detector", with_fused_detector, "square");
  closed_loop("platform_collision", shipped, "platform_collision");
  closed_loop("clamping", shipped, "clamping");
  closed_loop("platform_collision_fused", shipped, "platform_collision_fused");
  return true;
}();

}  // namespace
}  // namespace flinch
