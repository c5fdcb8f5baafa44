// A simulated millisecond of the whole closed loop (plant, contact, sensors, control path, recorder) against
// MuJoCo's bare physics of the same robot: one step of its RK4 at 1 ms, without sensors, control, contact or
// recording. Both are timed in turn in the same run; `over_mujoco` is the ratio of the processor times.
#include <benchmark/benchmark.h>

#include <chrono>
#include <string>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/quantity_units.h"
#include "tests/support/processor_time.h"
#ifdef FLINCH_HAS_MUJOCO
#include "tests/peer/mujoco_bench.h"
#endif

namespace flinch {
namespace {

using Seconds = std::chrono::duration<double>;
constexpr int ticks_in_turn = 100;

std::string scenario_file(const std::string& name) {
  return std::string(FLINCH_SOURCE_DIR) + "/apps/scenarios/" + name + ".yaml";
}

/// A scenario that starts over and over again.
class ClosedLoop {
 public:
  explicit ClosedLoop(const std::string& name)
      : scenario_(read_simulated_scenario(scenario_file(name))),
        experiment_(build_experiment(scenario_)),
        recorder_(*experiment_.diagram, recordable_paths(*experiment_.diagram), samples(),
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
  }

 private:
  std::size_t samples() const { return static_cast<std::size_t>(scenario_.duration / 1ms); }

  SimulatedScenario scenario_;
  Experiment experiment_;
  Recorder recorder_;
  Simulator simulator_;
  Context start_;
  Context context_;
};

#ifdef FLINCH_HAS_MUJOCO
/// MuJoCo's model of the bench, swinging freely from a moving start.
class FreeBench {
 public:
  FreeBench() : mujoco_(parameters(), bench_link1(), bench_link2()) {
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
  static PlanarRrrParameters parameters() {
    return bench_robot(BenchGeometry::nominal, BenchFriction::simulation);
  }

  void restart() {
    const Eigen::Vector3d pose(0.0, 0.0, 0.0), velocity(0.3, 0.2, 0.5);
    Kinematics at;
    PlanarRrr(parameters()).kinematics(pose, velocity, at);
    const auto three = [](const JointVector& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
    mj_resetData(mujoco_.model(), mujoco_.data());
    mujoco_.set_state(pose, velocity, three(at.joints.active), three(at.joints.passive),
                      three(at.rates.active), three(at.rates.passive));
  }

  peer::MujocoBench mujoco_;
  int ticks_ = 0;
};
#endif

template <class System>
Seconds time_ticks(System& system) {
  const Seconds start = test::processor_time();
  for (int i = 0; i < ticks_in_turn; ++i) system.tick();
  return test::processor_time() - start;
}

void ClosedLoopMillisecond(benchmark::State& state, const std::string& scenario) {
  ClosedLoop loop(scenario);
  Seconds ours{}, worst{};
#ifdef FLINCH_HAS_MUJOCO
  FreeBench bench;
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
BENCHMARK_CAPTURE(ClosedLoopMillisecond, square, std::string("square"))->UseManualTime();
BENCHMARK_CAPTURE(ClosedLoopMillisecond, platform_collision, std::string("platform_collision"))
    ->UseManualTime();
BENCHMARK_CAPTURE(ClosedLoopMillisecond, clamping, std::string("clamping"))->UseManualTime();

}  // namespace
}  // namespace flinch
