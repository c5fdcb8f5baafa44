#include "systems/motion/platform_path.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double check_interval = 0.005;  // [s]
constexpr double longest = 1e4;           // of what is checked [s]

std::string text(const Configuration& pose) {
  std::ostringstream stream;
  stream << pose.transpose().format({5, Eigen::DontAlignCols, ", ", ", ", "", "", "(", ")"});
  return stream.str();
}

/// `duration`: of the part that is checked; where laps follow one another, one of them.
void check_reach(const ParallelRobot& robot, const PlatformPath& path, double duration) {
  if (!(duration <= longest)) {
    std::ostringstream problem;
    problem << "platform path: takes " << duration << " s, and may take " << longest
            << " s; raise the limits, or shorten the way or the pauses";
    throw SetupError(problem.str());
  }
  const int samples = static_cast<int>(std::ceil(duration / check_interval));
  for (int i = 0; i <= samples; ++i) {
    const double time = samples == 0 ? 0.0 : duration * i / samples;
    const Configuration pose = path.evaluate(time).pose;
    if (!robot.space().contains(pose) ||
        !robot.inverse_kinematics(pose, robot.home_working_mode()).reachable) {
      throw SetupError("platform path: the legs do not reach the pose " + text(pose) + " at " +
                       std::to_string(time) + " s");
    }
  }
}

/// Time and distance from rest to `speed`.
struct RunUp {
  double time;
  double distance;
};

RunUp run_up(double speed, double acceleration, double jerk) {
  const bool reaches_limit = speed * jerk >= acceleration * acceleration;
  const double time =
      reaches_limit ? speed / acceleration + acceleration / jerk : 2.0 * std::sqrt(speed / jerk);
  return {time, speed * time / 2.0};
}

}  // namespace

PlatformPath::PlatformPath(const ParallelRobot& robot, std::variant<Legs, WaypointCircuit> course,
                           double duration)
    : course_(std::move(course)), duration_(duration) {
  start_ = evaluate(0.0).pose;
  const auto* const circuit = std::get_if<WaypointCircuit>(&course_);
  check_reach(robot, *this, circuit == nullptr ? duration_ : circuit->lap_duration());
}

PlatformPath PlatformPath::through(const ParallelRobot& robot, const std::vector<Configuration>& poses,
                                   const PoseLimits& limits, double pause) {
  if (!(pause >= 0.0 && std::isfinite(pause)))
    throw SetupError("platform path: the pause must be finite and not negative");
  if (poses.empty()) throw SetupError("platform path: there must be at least one pose");
  Legs legs;
  double begin = 0.0;
  Configuration from = poses.front();
  for (std::size_t i = std::min<std::size_t>(1, poses.size() - 1); i < poses.size(); ++i) {
    if (!robot.space().contains(poses[i]) || !robot.space().contains(from)) {
      throw SetupError("platform path: pose " + std::to_string(i) + " is not one of this robot");
    }
    const PlatformVector rest = PlatformVector::Zero(robot.dof());
    const PlatformVector displacement = robot.difference(poses[i], from);
    if (!legs.empty()) begin += pause;
    legs.push_back({begin, PoseMotion::plan(robot.space(), from, rest, displacement, limits)});
    if (!legs.back().motion.valid()) throw SetupError("platform path: limits must be positive and finite");
    begin += legs.back().motion.duration();
    from = legs.back().motion.goal();
  }
  return {robot, std::move(legs), begin};
}

PlatformPath PlatformPath::around(const ParallelRobot& robot, const WaypointCircuit& circuit) {
  if (!circuit.valid()) throw SetupError("platform path: the circuit could not be planned");
  return {robot, circuit, circuit.duration()};
}

PlatformPath PlatformPath::square(const ParallelRobot& robot, const Configuration& centre, double side,
                                  const PoseLimits& limits, int laps) {
  return around(robot, WaypointCircuit::plan(robot.space(), square_corners(centre, side), limits, laps));
}

PlatformReference PlatformPath::evaluate(double time) const noexcept {
  if (const auto* circuit = std::get_if<WaypointCircuit>(&course_)) return circuit->evaluate(time);
  const Legs& legs = *std::get_if<Legs>(&course_);
  const auto later = std::upper_bound(legs.begin() + 1, legs.end(), time,
                                      [](double now, const Leg& leg) { return now < leg.begin; });
  const Leg& leg = *(later - 1);
  PlatformReference reference = leg.motion.evaluate(time - leg.begin);
  reference.finished = reference.finished && later == legs.end();
  return reference;
}

Passage passage(const ParallelRobot& robot, const PassageSettings& settings) {
  const auto& [pose, direction, speed, cruise, acceleration, jerk] = settings;
  const bool usable = robot.space().contains(pose) && direction.size() == robot.space_dimension() &&
                      direction.allFinite() && direction.norm() > 0 && cruise >= 0;
  if (!usable || !can_be_planned_with({speed, acceleration, jerk})) {
    throw SetupError(
        "passage: pose and direction must fit the robot, speed, acceleration and jerk be positive");
  }
  const RunUp up = run_up(speed, acceleration, jerk);
  PlatformVector half = PlatformVector::Zero(robot.dof());
  half.head(robot.space_dimension()) = (up.distance + cruise) * direction.normalized();
  const MotionLimits limits{speed, acceleration, jerk};
  const ConfigurationSpace& space = robot.space();
  return {PlatformPath::through(robot, {space.plus(pose, -half), space.plus(pose, half)}, {limits, limits}),
          up.time + cruise / speed};
}

}  // namespace flinch
