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
#include "systems/robot/parallel_robot.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"
#include "tests/fault/lies/lie_stage.h"

namespace flinch::test {
namespace {

constexpr Time start = 300ms;     // of the motion
constexpr Time watched = 400ms;   // after the lie
constexpr double resting = 0.02;  // speed of a platform that rests [m/s]

/// Of the motion, in the plane.
Eigen::Vector2d direction(const LieScene& scene) {
  const double angle = scene.direction_deg * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

Passage passing(const LieScene& scene) {
  const LieStage& stage = lie_stage(scene.robot);
  const ParallelRobot& robot = *stage.robot.robot;
  CartesianVector along = CartesianVector::Zero(robot.space_dimension());
  along.head<2>() = direction(scene);
  return passage(robot, {.pose = robot.home_pose(),
                         .direction = along,
                         .speed = scene.speed,
                         .cruise = stage.cruise,
                         .acceleration = stage.acceleration,
                         .jerk = stage.jerk});
}

std::string direction_key(const LieScene& scene) {
  if (lie_stage(scene.robot).robot.robot->space_dimension() == 2)
    return fmt::format("direction_deg: {}", scene.direction_deg);
  return fmt::format("direction: [{}, {}, 0]", direction(scene).x(), direction(scene).y());
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

std::string text_of(const LieScene& scene, const std::string& faults) {
  std::ostringstream text;
  const LieStage& stage = lie_stage(scene.robot);
  text << "robot: " << stage.file << "\nseed: " << scene.seed
       << "\nduration_s: " << to_seconds(lie_at(scene) + watched)
       << "\ncontrol_period_us: " << 1e6 * to_seconds(scene.period) << "\n";
  if (scene.speed > 0.0) {
    text << "motion: {kind: passage, start_s: " << to_seconds(start) << ", " << direction_key(scene)
         << ", speed_m_per_s: " << scene.speed << ", cruise_m: " << stage.cruise
         << ", acceleration_m_per_s2: " << stage.acceleration << ", jerk_m_per_s3: " << stage.jerk << "}\n";
  }
  if (scene.moment == LieMoment::stop)
    text << "operator: [{at_s: " << to_seconds(lie_at(scene) - before_lie(scene)) << ", press: stop}]\n";
  if (touches(scene)) text << stage.obstacle(1e3 * scene.speed * to_seconds(before_lie(scene)));
  text << "plant: {realism: " << scene.realism << "}\n";
  if (!scene.passive_encoders && stage.robot.robot->passive_joints() > 0)
    text << "sensors: {encoders: {passive_mounted: false}}\n";
  text << stage.control << faults;
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
  scenario.control.forward_kinematics.initial_pose = scenario.station.rig.initial_pose.value_or(
      scenario.robot.robot->home_pose());  // without passive encoders nothing else tells it
  const Recording recording = run_experiment(scenario);
  LieRun run;
  run.speed.resize(recording.samples());
  run.position.resize(recording.samples());
  for (int axis = 0; axis < scenario.robot.robot->space_dimension(); ++axis) {
    const auto position = recording.column("truth", "pose", axis);
    const auto velocity = recording.column("truth", "velocity", axis);
    for (std::size_t k = 0; k < velocity.size(); ++k) {
      run.position[k][static_cast<std::size_t>(axis)] = position[k];
      run.speed[k] = std::hypot(run.speed[k], velocity[k]);
    }
  }
  run.energy = recording.column("truth", "kinetic_energy");
  run.phase = recording.column("gate", "phase");
  run.fault = recording.column("gate", "fault");
  run.reaction = recording.column("gate", "reaction");
  run.force = recording.column("contact", "peak_force");
  for (int i = 0; i < scenario.robot.robot->drives(); ++i)
    run.torque.push_back(recording.column("truth", "drive_torque", i));
  return run;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
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
  const Time grid = std::max<Time>(1ms, scene.period);
  return start / grid * grid + from_seconds(passing(scene).time) / grid * grid;
}

LieRun honest_run(const LieScene& scene) { return run(scene, ""); }

LieOutcome try_lie(const LieScene& scene, const std::string& lie, const LieRun& honest) {
  const LieRun lied = run(scene, lie);
  const auto time_of = [&scene](std::size_t ticks) { return scene.period * static_cast<Time::rep>(ticks); };
  LieOutcome outcome{.lie = lie, .scene = scene, .alarm = {}, .rest = {}};
  const auto begin = static_cast<std::size_t>((scene.from_standstill ? 280ms : lie_at(scene)) / scene.period);
  const std::size_t end = lied.speed.size();
  outcome.began =
      scene.moment == LieMoment::stop || lied.phase[begin - 1] == static_cast<double>(GatePhase::open);
  std::size_t alarm = begin;
  while (alarm < end && !has_answered(scene, lied, alarm)) ++alarm;
  if (alarm < end) {
    outcome.alarm = time_of(alarm - begin);
    outcome.fault = static_cast<GateFault>(lied.fault[alarm]);
    outcome.named = names(outcome.fault) || scene.moment == LieMoment::stop;
  }
  const std::size_t last = std::min({end, honest.speed.size()});
  const double percent = 100.0 / lie_stage(scene.robot).robot.drives.max_torque;
  for (std::size_t k = begin;
       k < std::min({last, alarm + 1, begin + static_cast<std::size_t>(50ms / scene.period) + 1}); ++k) {
    for (std::size_t i = 0; i < lied.torque.size(); ++i) {
      const double beyond = std::abs(lied.torque[i][k] - honest.torque[i][k]);
      outcome.torque = std::max(outcome.torque, percent * beyond);
    }
  }
  if (honest.force.back() > 0.0) outcome.force = lied.force.back() / honest.force.back();
  if (alarm >= end) {
    for (std::size_t k = begin; k < last; ++k)
      outcome.excess = std::max(outcome.excess, lied.speed[k] - honest.speed[k]);
    return outcome;
  }
  std::size_t rest = end;
  while (rest > alarm && lied.speed[rest - 1] < resting) --rest;
  outcome.watched = time_of(end - alarm);
  if (rest < end) outcome.rest = time_of(rest - alarm);
  std::size_t most = alarm;
  for (std::size_t k = alarm; k < last; ++k) {
    outcome.excess = std::max(outcome.excess, lied.speed[k] - honest.speed[k]);
    if (lied.energy[k] > lied.energy[most]) most = k;
    if (k > alarm && k <= rest) outcome.travel += distance(lied.position[k], lied.position[k - 1]);
  }
  outcome.growth = time_of(most - alarm);
  return outcome;
}

std::string problem_with(const LieOutcome& is) {
  const bool in_time = is.named && is.alarm && *is.alarm <= 50ms;
  if (is.torque > 30.0 && !in_time)
    return fmt::format("{:.0f} % of the largest torque without a name", is.torque);
  if (is.scene.moment == LieMoment::stop && !is.alarm && is.excess > 0.3)
    return fmt::format("{:.2f} m/s above the honest stop, without brakes", is.excess);
  if (!is.alarm || !is.named) return "";
  const Time patience = is.scene.brakes > 5ms ? 60ms : 30ms;
  if (is.excess > 0.3) return fmt::format("{:.2f} m/s above the honest run", is.excess);
  if (is.rest.value_or(is.watched) > patience) return "it does not come to rest in time";
  if (is.growth > 5ms) return fmt::format("its energy grows for {} ms", is.growth / 1ms);
  return "";
}

std::string table_head() {
  return "robot        lie                                      sensors moment    m/s  deg  alarm ms  fault  "
         "named   % "
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
      "{:12} {:40} {:7} {:8} {:4.1f} {:4.0f} {:>9} {:>6} {:>6} {:10.1f} {:10.2f} {:>8} {:10.1f} {:>16} "
      "{:6.2f}\n",
      is.scene.robot, is.lie, sensors, moments[static_cast<std::size_t>(is.scene.moment)], is.scene.speed,
      is.scene.direction_deg, ms(is.alarm), static_cast<int>(is.fault), is.named ? "yes" : "no", is.torque,
      is.excess, ms(is.rest), 1e3 * is.travel, ms(is.growth), is.force);
}

}  // namespace flinch::test
