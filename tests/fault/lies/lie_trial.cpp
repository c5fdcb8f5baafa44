#include "tests/fault/lies/lie_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/recording.h"
#include "systems/motion/platform_path.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"

namespace flinch::test {
namespace {

constexpr Time start = 300ms;     // of the motion
constexpr Time watched = 400ms;   // after the lie
constexpr double resting = 0.02;  // speed of a platform that rests [m/s]

Passage passing(const LieScene& scene) {
  static const PlanarRrr robot(bench_robot(BenchGeometry::individual, BenchFriction::test_bench));
  const double angle = scene.direction_deg * std::numbers::pi / 180.0;
  return passage(robot, {.pose = Eigen::Vector3d::Zero(),
                         .direction = Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                         .speed = scene.speed,
                         .cruise = 0.05});
}

bool touches(const LieScene& scene) {
  return scene.moment == LieMoment::contact || scene.moment == LieMoment::reaction;
}

/// From what the lie meets, a stop or the begin of a contact, until it begins.
Time before_lie(const LieScene& scene) {
  switch (scene.moment) {
    case LieMoment::motion:
      break;
    case LieMoment::stop:
      return 10ms;
    case LieMoment::contact:
      return 5ms;
    case LieMoment::reaction:
      return 40ms;
  }
  return 0ms;
}

/// Of a pylon that the platform meets on its way in the direction of -x: `before_lie` from the middle [mm].
double pylon_ahead(const LieScene& scene) {
  constexpr double reach = -175.0;  // of the platform, with the pylon's radius
  return reach + 1e3 * scene.speed * to_seconds(before_lie(scene));
}

std::string text_of(const LieScene& scene, const std::string& faults) {
  std::ostringstream text;
  text << "robot: " FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml\n"
       << "seed: " << scene.seed << "\nduration_s: " << to_seconds(lie_at(scene) + watched) << "\n";
  if (scene.speed > 0.0) {
    text << "motion: {kind: passage, start_s: " << to_seconds(start)
         << ", direction_deg: " << scene.direction_deg << ", speed_m_per_s: " << scene.speed
         << ", cruise_m: 0.05}\n";
  }
  if (scene.moment == LieMoment::stop)
    text << "operator: [{at_s: " << to_seconds(lie_at(scene) - before_lie(scene)) << ", press: stop}]\n";
  if (touches(scene))
    text << "pylon: {x_mm: " << pylon_ahead(scene)
         << ", y_mm: -20, radius_mm: 40, stiffness_N_per_m: 6000}\n";
  text << "plant: {realism: " << scene.realism << "}\n";
  if (!scene.passive_encoders) text << "sensors: {encoders: {passive_mounted: false}}\n";
  text << faults;
  return text.str();
}

void add_fault(std::ostringstream& list, const std::string& signal, const std::string& kind, Time time,
               const std::string& size) {
  list << "  - {signal: " << signal << ", kind: " << kind << ", time_s: " << to_seconds(time);
  if (!size.empty()) list << ", size: " << size;
  list << "}\n";
}

/// "encoder2:drifting:-5+brakes:off" as a list of a scenario.
std::string faults_of(const LieScene& scene, const std::string& lie) {
  std::ostringstream list;
  if (!scene.imu) add_fault(list, "imu", "off", 0ms, "");
  if (scene.brakes > 0ms)
    add_fault(list, "brakes", "delayed", 0ms, fmt::format("{}", to_seconds(scene.brakes)));
  std::istringstream lies(lie);
  const Time when = scene.from_standstill ? 280ms : lie_at(scene);
  for (std::string each; std::getline(lies, each, '+');) {
    std::istringstream words(each);
    std::string signal, kind, size;
    std::getline(words, signal, ':');
    std::getline(words, kind, ':');
    std::getline(words, size, ':');
    add_fault(list, signal, kind, when, size);
  }
  return list.str().empty() ? "" : "faults:\n" + list.str();
}

LieRun run(const LieScene& scene, const std::string& lie) {
  SimulatedScenario scenario =
      parse_simulated_scenario(text_of(scene, faults_of(scene, lie)), "lie.yaml", scene.seed);
  scenario.control.forward_kinematics.initial_pose = scenario.station.bench.initial_pose.value_or(
      scenario.robot.robot->home_pose());  // without passive encoders nothing else tells it
  const Recording recording = run_experiment(scenario);
  LieRun run;
  run.x = recording.column("truth", "pose", 0);
  run.y = recording.column("truth", "pose", 1);
  const auto vx = recording.column("truth", "velocity", 0);
  const auto vy = recording.column("truth", "velocity", 1);
  for (std::size_t k = 0; k < vx.size(); ++k) run.speed.push_back(std::hypot(vx[k], vy[k]));
  run.energy = recording.column("truth", "kinetic_energy");
  run.phase = recording.column("gate", "phase");
  run.fault = recording.column("gate", "fault");
  run.reaction = recording.column("gate", "reaction");
  run.force = recording.column("contact", "peak_force");
  for (int i = 0; i < 3; ++i) run.torque.push_back(recording.column("truth", "drive_torque", i));
  return run;
}

/// Whether the gate has answered a lie at this tick: closed, or in a stop that had begun before, the brakes.
bool has_answered(const LieScene& scene, const LieRun& run, std::size_t tick) {
  if (scene.moment == LieMoment::stop)
    return run.reaction[tick] == static_cast<double>(GateReaction::zero_torque_and_brake);
  return run.phase[tick] == static_cast<double>(GatePhase::closed);
}

bool names(GateFault fault) {
  for (const FaultRow& row : fault_table()) {
    if (row.fault == fault) return row.doubt != Doubt::nothing && row.doubt != Doubt::laws;
  }
  return false;
}

}  // namespace

Time lie_at(const LieScene& scene) {
  if (scene.speed <= 0.0) return 500ms;
  return start + from_seconds(passing(scene).time) / 1ms * 1ms;
}

LieRun honest_run(const LieScene& scene) { return run(scene, ""); }

LieOutcome try_lie(const LieScene& scene, const std::string& lie, const LieRun& honest) {
  const LieRun lied = run(scene, lie);
  LieOutcome outcome{.lie = lie, .scene = scene, .alarm = {}, .rest = {}};
  const auto begin = static_cast<std::size_t>((scene.from_standstill ? 280ms : lie_at(scene)) / 1ms);
  const std::size_t end = lied.speed.size();
  outcome.began =
      scene.moment == LieMoment::stop || lied.phase[begin - 1] == static_cast<double>(GatePhase::open);
  std::size_t alarm = begin;
  while (alarm < end && !has_answered(scene, lied, alarm)) ++alarm;
  if (alarm < end) {
    outcome.alarm = Time(1ms) * static_cast<Time::rep>(alarm - begin);
    outcome.fault = static_cast<GateFault>(lied.fault[alarm]);
    outcome.named = names(outcome.fault) || scene.moment == LieMoment::stop;
  }
  const std::size_t last = std::min({end, honest.speed.size()});
  for (std::size_t k = begin; k < std::min({last, alarm + 1, begin + 51}); ++k) {
    for (std::size_t i = 0; i < 3; ++i)
      outcome.torque = std::max(outcome.torque, std::abs(lied.torque[i][k] - honest.torque[i][k]));
  }
  if (honest.force.back() > 0.0) outcome.force = lied.force.back() / honest.force.back();
  if (alarm >= end) {
    for (std::size_t k = begin; k < last; ++k)
      outcome.excess = std::max(outcome.excess, lied.speed[k] - honest.speed[k]);
    return outcome;
  }
  std::size_t rest = end;
  while (rest > alarm && lied.speed[rest - 1] < resting) --rest;
  if (rest < end) outcome.rest = Time(1ms) * static_cast<Time::rep>(rest - alarm);
  std::size_t most = alarm;
  for (std::size_t k = alarm; k < last; ++k) {
    outcome.excess = std::max(outcome.excess, lied.speed[k] - honest.speed[k]);
    if (lied.energy[k] > lied.energy[most]) most = k;
    if (k > alarm && k <= rest)
      outcome.travel += std::hypot(lied.x[k] - lied.x[k - 1], lied.y[k] - lied.y[k - 1]);
  }
  outcome.growth = Time(1ms) * static_cast<Time::rep>(most - alarm);
  return outcome;
}

std::string problem_with(const LieOutcome& is) {
  const bool in_time = is.named && is.alarm && *is.alarm <= 50ms;
  if (is.torque > 30.0 && !in_time) return fmt::format("{:.0f} Nm without a name", is.torque);
  if (is.scene.moment == LieMoment::stop && !is.alarm && is.excess > 0.3)
    return fmt::format("{:.2f} m/s above the honest stop, without brakes", is.excess);
  if (!is.alarm || !is.named) return "";
  const Time patience = is.scene.brakes > 5ms ? 60ms : 30ms;
  if (is.excess > 0.3) return fmt::format("{:.2f} m/s above the honest run", is.excess);
  if (!is.rest || *is.rest > patience) return "it does not come to rest in time";
  if (is.growth > 5ms) return fmt::format("its energy grows for {} ms", is.growth / 1ms);
  return "";
}

std::string table_head() {
  return "lie                                      sensors moment    m/s  deg  alarm ms  fault  named  Nm "
         "before  "
         "m/s above  rest ms  "
         "travel mm "
         " energy grows ms  force\n";
}

std::string line_of(const LieOutcome& is) {
  const auto ms = [](std::optional<Time> time) {
    return time ? fmt::format("{}", *time / 1ms) : std::string("-");
  };
  constexpr std::array moments{"motion", "stop", "contact", "reaction"};
  const std::string sensors =
      fmt::format("{}{}", is.scene.passive_encoders ? "p" : "-", is.scene.imu ? "i" : "-");
  return fmt::format(
      "{:40} {:7} {:8} {:4.1f} {:4.0f} {:>9} {:>6} {:>6} {:10.1f} {:10.2f} {:>8} {:10.1f} {:>16} {:6.2f}\n",
      is.lie, sensors, moments[static_cast<std::size_t>(is.scene.moment)], is.scene.speed,
      is.scene.direction_deg, ms(is.alarm), static_cast<int>(is.fault), is.named ? "yes" : "no", is.torque,
      is.excess, ms(is.rest), 1e3 * is.travel, ms(is.growth), is.force);
}

}  // namespace flinch::test
