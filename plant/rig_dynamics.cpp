#include "plant/rig_dynamics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plant/general_rig.h"
#include "plant/planar_rig.h"
#include "plant/rig_of.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

const RigSettings& checked(const RigSettings& settings) {
  throw_if_any(problems(settings));
  return settings;
}

/// Dry friction that holds: `way` from where it bears nothing, over its give, counts up to `most_give` either
/// way.
struct Held {
  double way;

  double share() const { return std::clamp(way, -most_give, most_give); }
  bool slides() const { return std::abs(way) > most_give; }
  /// `rate` over the rate that counts as much as its give.
  double effort(double most_effort, double rate) const { return -most_effort * std::tanh(rate + share()); }
};

bool all_round(const Obstacles& obstacles) {
  return std::all_of(obstacles.begin(), obstacles.end(), [](const auto& obstacle) {
    return std::holds_alternative<Sphere>(obstacle->form().shape);
  });
}

}  // namespace

std::unique_ptr<const RigDynamics> RigDynamics::make(const RigSettings& settings) {
  const auto planar = std::dynamic_pointer_cast<const PlanarRrr>(checked(settings).robot);
  if (planar && all_round(settings.obstacles)) return std::make_unique<const RigOf<PlanarRig>>(settings);
  return std::make_unique<const RigOf<GeneralRig>>(settings);
}

RigDynamics::RigDynamics(const RigSettings& settings)
    : settings_(settings), dof_(settings.robot->dof()), size_(2 * dof_) {
  bool timed = !settings_.pulls.empty();
  for (std::size_t i = 0; i < settings_.obstacles.size(); ++i) {
    const Obstacle& obstacle = *settings_.obstacles[i];
    obstacle_at_[i] = obstacle.moves_freely() ? size_ : -1;
    if (obstacle.moves_freely()) size_ += 6;
    timed = timed || obstacle.follows_time();
  }
  if (timed) time_at_ = size_++;
  if (settings_.elastic.any()) {
    elastic_ =
        ElasticDrives(settings_.elastic, robot(), settings_.initial_pose.value_or(robot().home_pose()));
    twist_at_ = size_;
    size_ += 2 * robot().drives();
  }
  for (int i = 0; i < robot().drives(); ++i) friction_.push_back(robot().dry_friction(i));
  brakes_ = closed_brakes();
}

std::vector<RigDynamics::ClosedBrake> RigDynamics::closed_brakes() const {
  constexpr double fastest = 2e5;  // of a drive on its brake [1/s]
  Kinematics home;
  MotionEquations equations;
  robot().equations_of_motion(settings_.initial_pose.value_or(robot().home_pose()),
                              PlatformVector::Zero(robot().dof()), home, equations);
  const BrakeFriction& brake = settings_.brake;
  std::vector<ClosedBrake> brakes;
  for (int i = 0; i < robot().drives(); ++i) {
    const bool slides = robot().drive_kind(i) == DriveKind::prismatic;
    ClosedBrake& closed =
        brakes.emplace_back(slides ? ClosedBrake{brake.force, brake.sliding_velocity, brake.sliding_give}
                                   : ClosedBrake{brake.torque, brake.velocity, brake.give});
    if (!equations.valid) continue;
    const PlatformVector by_rate = home.J_qa_x.row(i).transpose();
    const double mobility = elastic_.any() ? 1.0 / elastic_.rotor_inertia(i)  // 1 / what the brake holds
                                           : by_rate.dot(equations.M_x.llt().solve(by_rate));
    closed.velocity = std::max(closed.velocity, closed.effort * mobility / fastest);
    closed.give = std::max(closed.give, closed.effort * mobility / (fastest * fastest));
  }
  return brakes;
}

RigState RigDynamics::initial_state() const {
  RigState state = RigState::Zero(size_);
  const RigChart chart = initial_step().chart;
  state.head(dof_) = chart.xi;
  if (settings_.initial_velocity) state.segment(dof_, dof_) = *settings_.initial_velocity;
  for (std::size_t i = 0; i < settings_.obstacles.size(); ++i) {
    if (obstacle_at_[i] < 0) continue;
    const ObstacleMotion start = settings_.obstacles[i]->motion(0.0);
    state.segment<3>(obstacle_at_[i]) = start.displacement;
    state.segment<3>(obstacle_at_[i] + 3) = start.velocity;
  }
  if (elastic_.any()) {
    Kinematics start;
    robot().kinematics(chart.pose, state.segment(dof_, dof_), start);
    for (int i = 0; i < robot().drives(); ++i) state[twist_at_ + i] = elastic_.twist_at_start(i);
    state.segment(motor_rate_at(), robot().drives()) = start.rates.active;
  }
  return state;
}

RigStep RigDynamics::initial_step() const {
  RigStep step;
  const Configuration pose = settings_.initial_pose.value_or(robot().home_pose());
  step.chart = {pose, robot().difference(pose, robot().space().origin())};
  step.search.candidates = ContactCandidates::all();
  return step;
}

ObstacleMotion RigDynamics::motion(std::size_t obstacle, const RigState& state) const noexcept {
  const int at = obstacle_at_[obstacle];
  if (at < 0) return settings_.obstacles[obstacle]->motion(time(state));
  return {state.segment<3>(at), state.segment<3>(at + 3)};
}

void RigDynamics::place_obstacles(const RigState& state, PlacedObstacles& out) const noexcept {
  for (std::size_t i = 0; i < settings_.obstacles.size(); ++i) {
    const ObstacleMotion now = motion(i, state);
    out[i] = {settings_.obstacles[i]->form().position_in_base + now.displacement, now.velocity};
  }
}

void RigDynamics::add_obstacle_rates(const RigState& state, const ContactForces& contacts,
                                     RigState& rates) const noexcept {
  for (std::size_t i = 0; i < settings_.obstacles.size(); ++i) {
    const int at = obstacle_at_[i];
    if (at < 0) continue;
    const ObstacleMotion now = motion(i, state);
    rates.segment<3>(at) = now.velocity;
    rates.segment<3>(at + 3) =
        settings_.obstacles[i]->acceleration(time(state), now, contacts.on_obstacle[i]);
  }
  if (time_at_ >= 0) rates[time_at_] = 1.0;
}

double RigDynamics::way(int drive, double from, double to) const noexcept {
  const bool slides = robot().drive_kind(drive) == DriveKind::prismatic;
  return slides ? to - from : std::remainder(to - from, 2.0 * std::numbers::pi);
}

double RigDynamics::brake_effort(int drive, double rate, double position, double braked_at) const noexcept {
  const ClosedBrake& brake = brakes_[static_cast<std::size_t>(drive)];
  return Held{way(drive, braked_at, position) / brake.give}.effort(brake.effort, rate / brake.velocity);
}

double RigDynamics::slides_to(int drive, double position, double held_at, double give) const noexcept {
  const Held held{way(drive, held_at, position) / give};
  return held.slides() ? position - give * held.share() : held_at;
}

double RigDynamics::brake_slides_to(int drive, double position, double braked_at) const noexcept {
  return slides_to(drive, position, braked_at, brakes_[static_cast<std::size_t>(drive)].give);
}

double RigDynamics::sticking_effort(int drive, double rate, double position, double stuck_at) const noexcept {
  const auto index = static_cast<std::size_t>(drive);
  const DryFriction& friction = friction_[index];
  if (!(friction.effort > 0.0)) return 0.0;
  const StickingFriction& sticking = settings_.sticking;
  const bool slides = robot().drive_kind(drive) == DriveKind::prismatic;
  const Held held{way(drive, stuck_at, position) * sticking.stiffness[drive] / friction.effort};
  return friction.at(rate) +
         held.effort(friction.effort, rate / (slides ? sticking.sliding_velocity : sticking.velocity));
}

double RigDynamics::friction_slides_to(int drive, double position, double stuck_at) const noexcept {
  const double give = friction_[static_cast<std::size_t>(drive)].effort / settings_.sticking.stiffness[drive];
  return give > 0.0 ? slides_to(drive, position, stuck_at, give) : stuck_at;
}

}  // namespace flinch
