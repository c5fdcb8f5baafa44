// What it costs to keep the robot within its limits for a tick, as a multiple of one evaluation of the
// model's kinematics and dynamics: far from all limits, and in a corner of them, where the quadratic
// programme has most to do. Likewise what is computed to be told alone: whether the robot could stop, at the
// tick of a detection, and the Lyapunov function of a task, at every tick.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "systems/framework/diagram_builder.h"
#include "systems/laws/safety_filter.h"
#include "systems/laws/task_energy.h"
#include "systems/model/robot_model.h"
#include "systems/robot/braking_set.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/support/processor_time.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> bench() {
  static const auto robot =
      std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  return robot;
}

SafetyFilterSettings strict_settings() {
  constexpr double degree = std::numbers::pi / 180.0;
  SafetyFilterSettings settings;
  settings.use = SafetyFilterSettings::Use::always;
  settings.limits.workspace = {.centre = {},
                               .max_distance = 0.35,
                               .max_rotation = 29.0 * degree,
                               .min_abs_det_A = 0.2,
                               .min_abs_det_B = 0.15,
                               .min_self_collision_distance = 0.17,
                               .min_active = -35.0 * degree,
                               .max_active = 150.0 * degree};
  settings.limits.max_condition_number = 15.0;
  settings.max_platform_speed = 2.1;
  settings.max_drive_speed = 7.6;
  return settings;
}

/// A model and, if wanted, the limits behind it, at one motion.
class Kept {
 public:
  Kept(const PlatformMotion& motion, const JointVector& torque, bool limits) : ticking_(wire(limits)) {
    ticking_.set(platform_, motion);
    if (!limits) return;
    ticking_.set(request_, TorqueCommand{.computed = {}, .valid = true, .torque = torque});
    ticking_.set(disturbance_, WrenchEstimate());
  }

  /// The best of several runs [s].
  double time_of_a_tick() {
    double best = 1.0;
    for (int run = 0; run < 20; ++run) {
      const auto begin = test::processor_time();
      for (int k = 0; k < 500; ++k) ticking_.tick();
      best = std::min(best, (test::processor_time() - begin).count() / 500.0);
    }
    return best;
  }
  void tick() { ticking_.tick(); }
  int steps() const { return static_cast<int>(ticking_.get(safety_filter_->status).steps); }

 private:
  DiagramBuilder& wire(bool limits) {
    auto& model = builder_.add<RobotModel>("model", bench());
    platform_ = builder_.input<PlatformMotion>("platform");
    builder_.connect(platform_, model.platform);
    if (!limits) return builder_;
    safety_filter_ = &builder_.add<SafetyFilter>("limits", bench(), strict_settings());
    builder_.connect(platform_, safety_filter_->motion);
    builder_.connect(model.kinematics, safety_filter_->kinematics);
    builder_.connect(model.dynamics, safety_filter_->dynamics);
    request_ = builder_.export_input("request", safety_filter_->request);
    commanded_ = builder_.export_input("commanded", safety_filter_->commanded);
    disturbance_ = builder_.export_input("disturbance", safety_filter_->disturbance);
    return builder_;
  }

  DiagramBuilder builder_{"bench", 1ms};
  SafetyFilter* safety_filter_ = nullptr;
  InputPort<PlatformMotion> platform_;
  InputPort<TorqueCommand> request_;
  InputPort<TorqueCommand> commanded_;
  InputPort<WrenchEstimate> disturbance_;
  test::Ticking ticking_;
};

void LimitTick(benchmark::State& state, const PlatformMotion& motion, const Eigen::Vector3d& torque) {
  Kept kept(motion, torque, true), model(motion, torque, false);
  for (auto unused : state) kept.tick();
  const double evaluation = model.time_of_a_tick();
  state.counters["times_the_model"] = (kept.time_of_a_tick() - evaluation) / evaluation;
  state.counters["steps"] = kept.steps();
}

PlatformMotion moving(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) {
  return {.acquired = {}, .status = PlatformMotion::Status::valid, .pose = pose, .velocity = velocity};
}

BENCHMARK_CAPTURE(LimitTick, far_from_all, moving({0.02, 0.01, 0.02}, {0.1, 0.1, 0.1}),
                  Eigen::Vector3d(1.0, -1.0, 1.0));
BENCHMARK_CAPTURE(LimitTick, in_a_corner, moving({0.33, 0.0, 0.0}, {1.9, 0.4, 3.0}),
                  Eigen::Vector3d(100.0, -100.0, 100.0));

/// The best of several times of `work` [s].
template <class Work>
double time_of(Work work) {
  double best = 1.0;
  for (int run = 0; run < 20; ++run) {
    const auto begin = test::processor_time();
    for (int k = 0; k < 200; ++k) work();
    best = std::min(best, (test::processor_time() - begin).count() / 200.0);
  }
  return best;
}

/// The model at one motion.
struct Modelled {
  Modelled(const Eigen::Vector3d& there, const Eigen::Vector3d& moving) : pose(there), velocity(moving) {
    evaluate();
  }
  void evaluate() {
    bench()->kinematics(pose, velocity, kinematics);
    bench()->dynamics(kinematics, dynamics);
  }
  double time_of_the_model() {
    return time_of([this] { evaluate(), benchmark::ClobberMemory(); });
  }

  PlatformVector pose, velocity;
  Kinematics kinematics;
  Dynamics dynamics;
};

void StraightStopOfLimits(benchmark::State& state) {
  Modelled at({0.02, 0.01, 0.02}, {0.5, 0.5, 0.5});
  const auto judge = [&at] {
    const StraightStop stop =
        straight_stop(*bench(), at.kinematics, at.dynamics, strict_settings().limits, 70.0);
    benchmark::DoNotOptimize(stop.stays_inside);
    return stop.stays_inside;
  };
  for (auto unused : state) judge();
  state.counters["times_the_model"] = time_of(judge) / at.time_of_the_model();
  state.counters["stays_inside"] = judge() ? 1.0 : 0.0;  // then every place has been looked at
}
BENCHMARK(StraightStopOfLimits);

void LyapunovFunctionOfATask(benchmark::State& state) {
  Modelled at({0.02, 0.01, 0.02}, {0.5, 0.5, 0.5});
  const Task task = platform_position_task(*bench(), at.kinematics);
  const PlatformVector error = PlatformVector::Constant(2, 0.01), rest = PlatformVector::Zero(2);
  const TaskGoal goal{task, {error, rest, rest}, TaskGains::uniform(2, 0, 0, 0, 2000.0, 1.0)};
  const auto measure = [&at, &goal] {
    benchmark::DoNotOptimize(energy_of(goal, at.kinematics, at.dynamics));
  };
  for (auto unused : state) measure();
  state.counters["times_the_model"] = time_of(measure) / at.time_of_the_model();
}
BENCHMARK(LyapunovFunctionOfATask);

}  // namespace
}  // namespace flinch
