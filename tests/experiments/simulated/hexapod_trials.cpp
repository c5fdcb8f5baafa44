#include "tests/experiments/simulated/hexapod_trials.h"
#include "systems/robot/robot_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "experiments/simulated/experiment.h"
#include "experiments/verdict/recorded_truth.h"
#include "plant/narrow_phase.h"
#include "plant/obstacle_path.h"
#include "systems/framework/random.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/motion/platform_path.h"
#include "tests/support/workplace.h"

namespace flinch::test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double ball_radius = 0.03;    // [m]
constexpr double ball_way = 0.16;       // of one that moves; it meets the platform in the middle [m]
constexpr double leg_clearance = 0.03;  // beyond the platform's surface [m]
constexpr double meeting_time = 0.6;    // [s]

/// How far a ball is in a direction from the origin of the platform, at home, when it touches a body on its
/// way inwards from the distance `from`; 0 where it passes [m].
double touching_distance(const Mechanism& robot, const Eigen::Vector3d& direction, int body, double from) {
  Kinematics at;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), at);
  const BodyId id = BodyId::from_index(body);
  const auto in_base = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return robot.point_on_body(at, id, point);
  };
  Placement placed{.origin = in_base(Eigen::Vector3d::Zero())};
  for (int axis = 0; axis < 3; ++axis)
    placed.axes.col(axis) = in_base(Eigen::Vector3d::Unit(axis)) - placed.origin;
  const Solid solid(robot.body(id).shapes.front());
  const Solid ball(Sphere{.radius = ball_radius});
  const Eigen::Vector3d origin = robot.home_pose().head<3>();
  double distance = from;
  for (int i = 0; i < 1000 && distance > 0.0; ++i) {  // the ball never jumps over what it has not reached
    const double gap = nearest(solid, placed, ball, {.origin = origin + distance * direction}).gap;
    if (gap < 1e-10) return distance;
    distance -= gap;
  }
  return 0.0;
}

double platform_distance(const Mechanism& robot, const Eigen::Vector3d& direction) {
  return touching_distance(robot, direction, BodyId::platform().index(), 1.0);
}

bool meets_platform_first(const Mechanism& robot, const Eigen::Vector3d& direction) {
  const double platform = platform_distance(robot, direction);
  for (int body = 1; body < robot.body_count(); ++body) {
    const double leg = touching_distance(robot, direction, body, platform + 0.5 * ball_way);
    if (leg > platform - leg_clearance) return false;
  }
  return true;
}

/// When an observer with the same gain that is told the true wrench would notice the contact [s].
double detected_at_best(const SimulatedScenario& trial, const Recording& recording, double onset) {
  const PlatformVector gain = trial.control.momentum_observer.gain;
  const ReactionThreshold& reaction = trial.control.contact_detector.reaction;
  const WrenchThreshold limit{reaction.force.largest(), reaction.moment.largest()};
  const RecordedValues<RecordedTruth> truth(recording, "truth");
  PlatformVector estimate = PlatformVector::Zero(gain.size()), before = estimate;
  const PlatformVector a = (-1e-3 * gain).array().exp();
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const double now = to_seconds(Time(recording.time_ns[k]));
    const PlatformVector wrench = truth[k].wrench_in_base;
    const PlatformVector mean = 0.5 * (before + wrench);
    estimate = mean + a.cwiseProduct(estimate - mean);
    before = wrench;
    const bool reached = estimate.head<3>().lpNorm<Eigen::Infinity>() >= limit.force ||
                         estimate.tail<3>().lpNorm<Eigen::Infinity>() >= limit.moment;
    if (now > onset && reached) return now - onset;
  }
  return never;
}

}  // namespace

SimulatedScenario hexapod_trial(std::uint64_t seed) {
  SimulatedScenario trial = read_simulated_scenario(shipped("scenarios/hexapod_push.yaml"), seed);
  trial.station.applied_wrench.clear();
  trial.control.sequence.zero_g_when_struck = false;
  return trial;
}

SimulatedScenario with_free_motion(SimulatedScenario trial, std::uint64_t seed) {
  const ParallelRobot& robot = *trial.robot.robot;
  RandomGenerator random(seed);
  std::vector<Configuration> poses{robot.home_pose()};
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    PlatformVector away(6);
    away << random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06), random.uniform(-0.05, 0.05),
        axis * random.uniform(0.0, std::numbers::pi / 12.0);
    poses.push_back(robot.space().plus(robot.home_pose(), away));
  }
  const PoseLimits limits{.translation = {.velocity = 0.6, .acceleration = 12.0, .jerk = 600.0},
                          .rotation = {.velocity = 3.0, .acceleration = 60.0, .jerk = 6000.0}};
  trial.control.trajectory.path = PlatformPath::through(robot, poses, limits);
  trial.control.trajectory.start = 300ms;
  trial.duration = 300ms + from_seconds(trial.control.trajectory.path->duration() + 0.1);
  trial.station.rig.initial_pose = trial.control.trajectory.path->start();
  return trial;
}

SimulatedScenario with_uneven_drives(SimulatedScenario trial, KnownFriction known, std::uint64_t seed) {
  RandomGenerator random(seed);
  RobotDeviation deviation;
  deviation.drive_friction_scale.setZero(trial.robot.robot->drives());
  for (double& scale : deviation.drive_friction_scale) scale = random.uniform(0.8, 1.2);
  trial.station.rig.robot = true_robot(trial.robot.robot, deviation);
  if (known == KnownFriction::of_each_drive) {
    trial.robot.robot = std::dynamic_pointer_cast<const ParallelRobot>(trial.station.rig.robot);
  }
  return trial;
}

SimulatedScenario unheeding(SimulatedScenario trial) {
  trial.control.contact_detector.reaction = {1e6, 1e6};
  trial.control.contact_detector.hard = {1e6, 1e6};
  return trial;
}

SimulatedScenario with_limits_above(SimulatedScenario trial, const Verdict& without_contact) {
  ContactDetectorSettings& detector = trial.control.contact_detector;
  detector.reaction = {
      .force = std::max(detector.reaction.force.largest(), 1.2 * without_contact.max_observer_error_force),
      .moment =
          std::max(detector.reaction.moment.largest(), 1.2 * without_contact.max_observer_error_moment)};
  detector.hard = {.force = std::max(detector.hard.force, detector.reaction.force.largest()),
                   .moment = std::max(detector.hard.moment, detector.reaction.moment.largest())};
  return trial;
}

std::vector<PlatformContact> draw_contacts(const SimulatedScenario& trial, int count, std::uint64_t seed) {
  RandomGenerator random(seed);
  std::vector<PlatformContact> contacts;
  while (static_cast<int>(contacts.size()) < count) {
    const Eigen::Vector3d towards(random.normal(), random.normal(), random.normal());
    const PlatformContact contact{.direction = towards.normalized(),
                                  .speed = random.uniform(0.2, 0.6),
                                  .ball_moves = contacts.size() % 2 == 1};
    if (meets_platform_first(*trial.robot.robot, contact.direction)) contacts.push_back(contact);
  }
  return contacts;
}

SimulatedScenario with_contact(SimulatedScenario trial, const PlatformContact& contact, Stiffness stiffness) {
  const ParallelRobot& robot = *trial.robot.robot;
  const double distance = platform_distance(robot, contact.direction);
  ObstacleForm ball{.name = "ball",
                    .shape = Sphere{.radius = ball_radius},
                    .position_in_base = robot.home_pose().head<3>() + distance * contact.direction};
  ball.material.stiffness = static_cast<double>(stiffness);
  trial.duration = 1500ms;
  trial.expected.contact = "platform";
  if (contact.ball_moves) {
    ball.position_in_base += 0.5 * ball_way * contact.direction;
    const double half = 0.5 * 1.875 * ball_way / contact.speed;  // paths are fastest in the middle
    trial.station.rig.obstacles = {std::make_shared<const MovingObstacle>(
        ball, ObstaclePath({{.time = meeting_time - half},
                            {.time = meeting_time + half, .displacement = -ball_way * contact.direction}}))};
    return trial;
  }
  const PassageSettings through{.pose = robot.home_pose(),
                                .direction = contact.direction,
                                .speed = contact.speed,
                                .cruise = 0.02,
                                .acceleration = 10.0,
                                .jerk = 1000.0};
  trial.control.trajectory.path = passage(robot, through).path;
  trial.control.trajectory.start = 300ms;
  trial.station.rig.initial_pose = trial.control.trajectory.path->start();
  trial.station.rig.obstacles = {std::make_shared<const FixedObstacle>(ball)};
  return trial;
}

ContactOutcome outcome_of(const SimulatedScenario& trial) {
  const Recording recording = run_experiment(trial);
  ContactOutcome outcome{
      .detected = never,
      .detected_at_best = never,
      .removed = never,
      .verdict = judge(recording, trial.robot.robot->space(), trial.expected, trial.force_limits)};
  if (outcome.verdict.contacts.empty()) return outcome;
  const ContactVerdict& first = outcome.verdict.contacts.front();
  outcome.detected = 1e3 * (first.detected.value_or(never) - first.onset);
  outcome.detected_at_best = 1e3 * detected_at_best(trial, recording, first.onset);
  outcome.removed = 1e3 * (first.removed.value_or(never) - first.onset);
  outcome.peak_force = first.peak_force;
  outcome.is_platform_alone = first.body == "platform";
  return outcome;
}

double median(std::vector<double> values) {
  if (values.empty()) return never;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace flinch::test
