// What integrating the plant costs, as ratios of processor times measured in turn in the same run:
//   over_rhs        a tick over its right-hand sides alone: what exceeds 1 is the integrator's own share
//   over_rk4        a tick over one step of the classical Runge-Kutta method
//   over_equal_rk4  a tick over that method with as few steps, equal_rk4_steps, as reach our accuracy
// A run is 1.4 s in closed loop. Its error is the largest one of the pose, against a run with a tolerance of
// 1e-13; accuracy is the geometric mean over runs along different paths, since single runs are better or
// worse by luck.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

#include "plant/rig_dynamics.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/runge_kutta.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/plant/rig_scene.h"
#include "tests/plant/servoed_station.h"
#include "tests/plant/truth_servo.h"
#include "tests/support/allocations.h"
#include "tests/support/processor_time.h"

namespace flinch {
namespace {

using Seconds = std::chrono::duration<double>;
using State = std::array<double, 6>;

constexpr int ticks = 1400;
constexpr int most_steps = 1024;
const std::array<Eigen::Vector3d, 5> path_frequencies = {  // [rad/s]
    Eigen::Vector3d(5.0, 4.0, 3.0), Eigen::Vector3d(8.0, 3.0, 5.0), Eigen::Vector3d(3.0, 7.0, 8.0),
    Eigen::Vector3d(6.0, 6.5, 2.0), Eigen::Vector3d(2.5, 5.0, 9.0)};

RigSettings bench(double pylon_stiffness) {
  RigSettings settings;
  settings.robot = test::individual_rig(RigFriction::test_rig);
  if (pylon_stiffness == 0.0) return settings;
  settings.obstacles = {test::fixed_post(0.32, 0.20, {.stiffness = pylon_stiffness})};
  return settings;
}

/// The bench between two ticks.
class Tick final : public DifferentialEquation {
 public:
  explicit Tick(const RigDynamics& dynamics)
      : step(dynamics.initial_step()), dynamics_(dynamics), state_(6), rates_(6) {
    drives.braked = false;
    drives.torque.setZero(3);
  }

  DriveAction drives;
  RigStep step;

  void rates(double, std::span<const double> y, std::span<double> rates) override {
    std::copy_n(y.data(), 6, state_.data());
    dynamics_.rates(state_, drives, no_wrench_, step, rates_);
    std::copy_n(rates_.data(), 6, rates.data());
  }

 private:
  const RigDynamics& dynamics_;
  PlatformVector no_wrench_ = PlatformVector::Zero(3);
  RigState state_;
  RigState rates_;
};

/// What a tick starts from.
struct Start {
  State y{};
  Eigen::Vector3d torque;
  ContactCandidates candidates;
};
using Run = std::vector<Start>;  // of every tick

/// A run of the bench under a servo whose torques are held for a millisecond.
Run run(const RigDynamics& dynamics, const Eigen::Vector3d& frequency, Integrator& integrator) {
  const test::Servo servo(dynamics.settings().robot, {.frequency = frequency});
  Tick tick(dynamics);
  Run starts;
  State y{};
  integrator.prepare(y.size());
  for (int k = 0; k < ticks; ++k) {
    const RigState state = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(y.data());
    tick.drives.torque = servo.torque(1e-3 * k, state.head<3>(), state.tail<3>());
    RigSnapshot snapshot;
    dynamics.snapshot(state, tick.drives, PlatformVector::Zero(3), tick.step, 1e-3, snapshot);
    tick.step.search.candidates = snapshot.search.candidates;
    starts.push_back({y, tick.drives.torque, tick.step.search.candidates});
    integrator.advance(tick, 1e-3, y);
  }
  return starts;
}

double largest_error(const Run& of, const Run& reference) {
  double largest = 0.0;
  for (std::size_t k = 0; k < of.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, std::abs(of[k].y[i] - reference[k].y[i]));
  }
  return largest;
}

/// Runs along all paths that are right to the last few digits.
std::vector<Run> references(const RigDynamics& dynamics) {
  SundialsIntegrator tight({.relative_tolerance = 1e-13, .absolute_tolerance = 1e-14});
  std::vector<Run> runs;
  for (const Eigen::Vector3d& frequency : path_frequencies) runs.push_back(run(dynamics, frequency, tight));
  return runs;
}

double accuracy(const RigDynamics& dynamics, const std::vector<Run>& references, Integrator& integrator) {
  double sum_of_logarithms = 0.0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    sum_of_logarithms +=
        std::log(largest_error(run(dynamics, path_frequencies[i], integrator), references[i]));
  }
  return std::exp(sum_of_logarithms / static_cast<double>(references.size()));
}

/// The fewest steps a tick with which the classical method errs no more than `error`.
int steps_of_equal_accuracy(const RigDynamics& dynamics, const std::vector<Run>& references, double error) {
  const auto reaches = [&](int steps) {
    RungeKutta method(steps);
    return accuracy(dynamics, references, method) <= error;
  };
  int high = 1;
  while (high < most_steps && !reaches(high)) high *= 2;
  int low = high / 2;  // does not reach it; 0 where one step does
  while (high - low > std::max(1, high / 16)) {
    const int middle = (low + high) / 2;
    (reaches(middle) ? high : low) = middle;
  }
  return high;
}

// ---------------------------------------------------------------- timing

/// Repeats all ticks of the runs, one by one, as fast as it can.
template <class Work>
Seconds time_ticks(Tick& tick, const std::vector<Run>& runs, Work&& work) {
  const Seconds begin = test::processor_time();
  for (const Run& run : runs) {
    for (const Start& start : run) {
      tick.drives.torque = start.torque;
      tick.step.search.candidates = start.candidates;
      State y = start.y;
      work(y);
      benchmark::DoNotOptimize(y);
    }
  }
  return test::processor_time() - begin;
}

Seconds time_integrator(Tick& tick, const std::vector<Run>& runs, Integrator& integrator) {
  return time_ticks(tick, runs, [&](State& y) { integrator.advance(tick, 1e-3, y); });
}

/// How many right-hand sides each tick takes.
std::vector<std::int64_t> evaluations_of_ticks(Tick& tick, const std::vector<Run>& runs,
                                               SundialsIntegrator& integrator) {
  std::vector<std::int64_t> counts;
  time_ticks(tick, runs, [&](State& y) {
    const std::int64_t before = integrator.evaluations();
    integrator.advance(tick, 1e-3, y);
    counts.push_back(integrator.evaluations() - before);
  });
  return counts;
}

/// Those right-hand sides alone, one after the other along the motion.
Seconds time_right_hand_sides(Tick& tick, const std::vector<Run>& runs,
                              const std::vector<std::int64_t>& counts) {
  auto count = counts.begin();
  return time_ticks(tick, runs, [&](State& y) {
    State rates{};
    const double step = 1e-3 / static_cast<double>(*count);
    for (std::int64_t i = 0; i < *count; ++i) {
      tick.rates(0.0, y, rates);
      for (std::size_t k = 0; k < 6; ++k) y[k] += step * rates[k];
    }
    ++count;
  });
}

double share_of_ticks_near_contact(const std::vector<Run>& runs) {
  double near = 0.0;
  for (const Run& run : runs) {
    for (const Start& start : run) near += start.candidates.count() > 0 ? 1.0 : 0.0;
  }
  return near / (ticks * static_cast<double>(runs.size()));
}

void PlantMillisecond(benchmark::State& state, double pylon_stiffness) {
  const auto shared = RigDynamics::make(bench(pylon_stiffness));
  const RigDynamics& dynamics = *shared;
  const std::vector<Run> runs = references(dynamics);
  SundialsIntegrator integrator;
  const double error = accuracy(dynamics, runs, integrator);
  const int equal_steps = steps_of_equal_accuracy(dynamics, runs, error);
  RungeKutta one_step(1);
  RungeKutta equal(equal_steps);
  one_step.prepare(6);
  equal.prepare(6);

  Tick tick(dynamics);
  const std::vector<std::int64_t> evaluations = evaluations_of_ticks(tick, runs, integrator);
  const test::AllocationCounter allocations;
  time_integrator(tick, runs, integrator);
  state.counters["allocations"] = static_cast<double>(allocations.count());

  Seconds ours{};
  Seconds right_hand_sides{};
  Seconds rk4{};
  Seconds equal_rk4{};
  for (auto unused : state) {
    const Seconds turn = time_integrator(tick, runs, integrator);
    state.SetIterationTime(turn.count());
    ours += turn;
    right_hand_sides += time_right_hand_sides(tick, runs, evaluations);
    rk4 += time_integrator(tick, runs, one_step);
    equal_rk4 += time_integrator(tick, runs, equal);
  }
  const auto all_ticks = static_cast<double>(evaluations.size());
  const auto all_evaluations =
      static_cast<double>(std::accumulate(evaluations.begin(), evaluations.end(), 0L));
  state.counters["us_per_ms"] = 1e6 * ours.count() / (all_ticks * static_cast<double>(state.iterations()));
  state.counters["over_rhs"] = ours / right_hand_sides;
  state.counters["over_rk4"] = ours / rk4;
  state.counters["over_equal_rk4"] = ours / equal_rk4;
  state.counters["equal_rk4_steps"] = equal_steps;
  state.counters["error"] = error;
  state.counters["rhs_per_tick"] = all_evaluations / all_ticks;
  state.counters["near_contact"] = share_of_ticks_near_contact(runs);
}
BENCHMARK_CAPTURE(PlantMillisecond, free_motion, 0.0)->UseManualTime();
BENCHMARK_CAPTURE(PlantMillisecond, contact_6_kN_per_m, 6e3)->UseManualTime();
BENCHMARK_CAPTURE(PlantMillisecond, contact_100_kN_per_m, 1e5)->UseManualTime();
BENCHMARK_CAPTURE(PlantMillisecond, contact_1_MN_per_m, 1e6)->UseManualTime();

/// A tick of the whole station with noisy sensors and a pylon in the way, servo included.
void StationMillisecond(benchmark::State& state) {
  SimulatedStationSettings settings;
  settings.rig = bench(6e3);
  test::ServoedStation station(settings);
  for (auto unused : state) station.step();
}
BENCHMARK(StationMillisecond);

}  // namespace
}  // namespace flinch
