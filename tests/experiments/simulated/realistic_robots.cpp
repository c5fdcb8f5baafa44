#include "tests/experiments/simulated/realistic_robots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/simulated/experiment.h"
#include "experiments/verdict/recorded_run.h"
#include "systems/framework/recording.h"
#include "systems/motion/random_path.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/in_parallel.h"
#include "tests/support/workplace.h"

namespace flinch::test {
namespace {

constexpr double force_threshold = 10.0;  // [N]
constexpr double moment_threshold = 1.0;  // [Nm]

PoseLimits limits_of(FreeMotion motion) {
  const bool harsh = motion == FreeMotion::harsh;
  return {
      .translation = {.velocity = 1.5, .acceleration = harsh ? 17.0 : 12.0, .jerk = harsh ? 2000.0 : 600.0},
      .rotation = {.velocity = 4.0, .acceleration = 80.0, .jerk = 8000.0}};
}

const char* name_of(FreeMotion motion) {
  switch (motion) {
    case FreeMotion::square:
      return "square";
    case FreeMotion::point_to_point:
      return "point to point";
    case FreeMotion::harsh:
      break;
  }
  return "harsh";
}

PlatformPath random_motion(const RobotFile& file, FreeMotion motion, std::uint64_t seed) {
  RandomPathSettings settings;
  settings.distance = 0.25;
  settings.limits = limits_of(motion);
  settings.workspace = file.limits;
  settings.max_drive_speed = file.drives.max_speed;
  return random_path(*file.robot, settings, seed);
}

/// Errors of one robot.
struct OneRobot {
  std::vector<double> forces, moments;  ///< Of every tick with an estimate.
  double seconds = 0.0;
  double tracking = 0.0;
  int crossings = 0;
  bool alarmed = false;
  std::vector<std::string> faults;
};

Verdict verdict_of(const SimulatedScenario& scenario, const Recording& recording) {
  return judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
}

void note_fault(const Verdict& verdict, std::uint64_t seed, OneRobot& robot) {
  if (!verdict.fault.empty()) robot.faults.push_back("seed " + std::to_string(seed) + ": " + verdict.fault);
}

OneRobot try_robot(const RobotTrial& trial, std::uint64_t seed) {
  OneRobot robot;
  const SimulatedScenario going_on = scenario_of(trial, seed, false);
  const Recording recording = run_experiment(going_on);
  const RecordedRun run(recording, going_on.robot.robot->space());
  double last_crossing = -1.0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const RunSample now = run[k];
    if (!now.estimate_valid) continue;
    robot.forces.push_back(now.observer_error_force);
    robot.moments.push_back(now.observer_error_moment);
    if (now.observer_error_force < force_threshold && now.observer_error_moment < moment_threshold) continue;
    if (now.time - last_crossing > Verdict::same_contact) ++robot.crossings;
    last_crossing = now.time;
  }
  const Verdict verdict = verdict_of(going_on, recording);
  robot.seconds = run.duration();
  robot.tracking = verdict.max_tracking_error;
  note_fault(verdict, seed, robot);

  const SimulatedScenario as_shipped = scenario_of(trial, seed, true);
  const Verdict shipped_verdict = verdict_of(as_shipped, run_experiment(as_shipped));
  robot.alarmed = shipped_verdict.false_detections > 0;
  note_fault(shipped_verdict, seed, robot);
  return robot;
}

double percentile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

SimulatedScenario scenario_of(const RobotTrial& trial, std::uint64_t seed, bool reacts) {
  const std::string file = trial.realistic ? "scenarios/square_realistic.yaml" : "scenarios/square.yaml";
  SimulatedScenario scenario = read_simulated_scenario(shipped(file), seed);
  scenario.control.aligned_with_velocity = trial.aligned;
  if (!reacts) scenario.control.contact_detector = {.reaction = {1e6, 1e6}, .hard = {1e6, 1e6}};
  if (trial.motion != FreeMotion::square) {
    scenario.control.trajectory.path = random_motion(scenario.robot, trial.motion, seed);
    scenario.station.rig.initial_pose = scenario.control.trajectory.path->start();
    const double end = to_seconds(scenario.control.trajectory.start.value_or(Time::zero())) +
                       scenario.control.trajectory.path->duration();
    scenario.duration = std::chrono::milliseconds(static_cast<int>(1e3 * end) + 200);
  }
  return scenario;
}

FreeMotionErrors try_robots(const RobotTrial& trial, int robots, std::uint64_t first_seed) {
  const std::vector<OneRobot> tried = in_parallel(static_cast<std::size_t>(robots), [&](std::size_t number) {
    return try_robot(trial, first_seed + number);
  });

  FreeMotionErrors errors;
  errors.robots = robots;
  std::vector<double> forces, moments;
  for (const OneRobot& robot : tried) {
    forces.insert(forces.end(), robot.forces.begin(), robot.forces.end());
    moments.insert(moments.end(), robot.moments.begin(), robot.moments.end());
    errors.seconds += robot.seconds;
    errors.tracking = std::max(errors.tracking, robot.tracking);
    errors.crossings += robot.crossings;
    errors.alarmed_robots += robot.alarmed ? 1 : 0;
    errors.faults.insert(errors.faults.end(), robot.faults.begin(), robot.faults.end());
  }
  if (forces.empty()) return errors;
  errors.p99_force = percentile(forces, 0.99);
  errors.p99_moment = percentile(moments, 0.99);
  errors.largest_force = percentile(forces, 1.0);
  errors.largest_moment = percentile(moments, 1.0);
  return errors;
}

std::string table_head() {
  return "  robots     motion          torque     robots     s   force N: max   p99   moment Nm: max   p99   "
         "tracking mm   contacts seen   robots stopped by one   faults\n";
}

std::string table_row(const RobotTrial& trial, const FreeMotionErrors& errors) {
  std::array<char, 256> row{};
  std::snprintf(row.data(), row.size(),
                "  %-9s  %-14s  %-9s  %6d  %4.0f  %12.2f %5.2f  %15.3f %5.3f  %12.2f  %14d  %22d  %7zu\n",
                trial.realistic ? "realistic" : "ideal", name_of(trial.motion),
                trial.aligned ? "aligned" : "unaligned", errors.robots, errors.seconds, errors.largest_force,
                errors.p99_force, errors.largest_moment, errors.p99_moment, 1e3 * errors.tracking,
                errors.crossings, errors.alarmed_robots, errors.faults.size());
  return row.data();
}

}  // namespace flinch::test
