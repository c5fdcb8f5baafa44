#include "systems/motion/reaction_task.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/motion/chart_motion.h"
#include "systems/motion/pose_goals.h"
#include "systems/robot/angles.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/link_segments.h"
#include "systems/robot/reaction_tasks.h"

namespace flinch {
namespace {

constexpr double least_push = 0.1;  // of what counts as felt: links near the base push the platform little
constexpr double slowest_closing = 0.02;  // of an elbow that bends; slower is noise [rad/s]

bool is_reacting(ReactionMode mode) { return mode == ReactionMode::react || mode == ReactionMode::hold; }

PlatformMatrix inverse(const PlatformMatrix& M) {
  return M.llt().solve(PlatformMatrix(PlatformMatrix::Identity(M.rows(), M.rows())));
}

// v = W J^T (J W J^T)^-1 d: how the platform moves where the task alone moves along `direction` with a rate
// of 1 and as little else as W allows.
PlatformVector least_motion(const Task& task, const PlatformVector& direction, const PlatformMatrix& W) {
  const PlatformMatrix W_J = W * task.J.transpose();
  const Eigen::LDLT<PlatformMatrix> mobility(PlatformMatrix(task.J * W_J));
  return W_J * PlatformVector(mobility.solve(direction));
}

// Of the platform's coupling joints from E.
double largest_reach(const Kinematics& at, int translations) {
  double reach = 0.0;
  for (int leg = 0; leg < drive_count(at); ++leg) {
    const CartesianVector& joint = at.legs[static_cast<std::size_t>(leg)].coupling_joint;
    if (joint.size() == translations) reach = std::max(reach, (joint - at.pose.head(translations)).norm());
  }
  return reach;
}

// Largest speed of a coupling joint in such a motion, on the torque level and on those of the drives.
double platform_speed(const Task& task, const PlatformVector& direction, const Kinematics& at,
                      const Dynamics& model, const ConfigurationSpace& space) {
  const PlatformMatrix by_inertia = inverse(model.M_x);
  const PlatformMatrix by_drives = at.J_x_qa * at.J_x_qa.transpose();
  const double reach = largest_reach(at, space.translations());
  double fastest = 0.0;
  for (const PlatformMatrix* const W : {&by_inertia, &by_drives}) {
    fastest = std::max(fastest, farthest_moved(space, least_motion(task, direction, *W), reach));
  }
  return fastest;
}

MotionLimits slowed(const MotionLimits& limits, double share) {
  return {limits.velocity * share, limits.acceleration * share, limits.jerk * share};
}

// The largest acceleration of the task along `direction` that all drives together can cause.
double largest_acceleration(const Task& task, const PlatformVector& direction, const Kinematics& at,
                            const Dynamics& model, double max_torque) {
  const PlatformVector along = task.J.transpose() * direction;
  return max_torque * (at.J_qa_x * (inverse(model.M_x) * along)).lpNorm<1>();
}

/// The elbow of a leg bends: what is between its links gets clamped.
bool is_closing(const Kinematics& at, int leg) {
  return at.joints.passive.size() > leg &&
         std::copysign(1.0, at.joints.passive[leg]) * at.rates.passive[leg] > slowest_closing;
}

/// A force on the second link comes from between the links.
bool opens_elbow(const Kinematics& at, int leg, const CartesianVector& force) {
  const LegPoints& points = at.legs[static_cast<std::size_t>(leg)];
  return force.dot(points.base_joint - points.passive_joint) < 0.0;
}

/// How the two joints of a leg move so that it opens, from `rate` on: by (31) the elbow stretches by twice as
/// much as the first link retreats, and the second link goes back by three times as much. Where the leg still
/// closes, the first link retreats by no more than it came, for each angle by which the elbow bent: there was
/// room for what is between the links.
PlatformVector opening_way(double passive, const PlatformVector& rate) {
  const double s = std::copysign(1.0, passive);
  const double bends = s * rate[1];
  const double retreat = bends > slowest_closing ? std::clamp(2.0 * s * rate[0] / bends, 0.0, 1.0) : 1.0;
  return Eigen::Vector2d(-s * retreat, -2.0 * s);
}

/// The force that acts on a link across its axis; empty where it is too weak to go by.
CartesianVector force_across(const Kinematics& at, BodyId link, const CartesianVector& force) {
  const Segment axis = link_segment(at, link);
  const CartesianVector along = (axis.end - axis.begin).normalized();
  return force - along.dot(force) * along;
}

}  // namespace

std::vector<std::string> problems(const ReactionTaskSettings& settings) {
  Findings found("reaction tasks: ");
  found.require(settings.displacement > 0, "displacement must be positive");
  found.require(settings.first_link_angle > 0, "first_link_angle must be positive");
  found.require(settings.opening_angle > 0 && settings.opening_step > 0, "openings must be positive");
  found.require(settings.largest_opening >= settings.opening_angle,
                "largest_opening must be at least opening_angle");
  found.require(settings.force_to_go_by > 0, "force_to_go_by must be positive");
  found.require(settings.load_to_go_by >= 0, "load_to_go_by must not be negative");
  found.require(settings.decide_within >= Time::zero(), "decide_within must not be negative");
  found.require(settings.released_force > 0 && settings.released_moment > 0,
                "thresholds of a release must be positive");
  found.require(settings.inertial_share >= 0, "inertial_share must not be negative");
  found.require(settings.pressed_for >= Time::zero(), "pressed_for must not be negative");
  found.require(settings.released_for >= Time::zero(), "released_for must not be negative");
  found.require(can_be_planned_with(settings.translation), "limits of translation must be positive");
  found.require(can_be_planned_with(settings.joint), "limits of joints must be positive");
  found.require(settings.largest_platform_speed > 0, "largest_platform_speed must be positive");
  const double share = settings.drive_share.value_or(1.0);
  found.require(share > 0 && share <= 1, "drive_share must be above 0 and at most 1");
  found.require(settings.rest_speed > 0, "rest_speed must be positive");
  found.require(settings.longest_braking >= Time::zero(), "longest_braking must not be negative");
  found.require(settings.max_torque > 0, "max_torque must be positive");
  found.require(settings.max_torque_rate > 0, "max_torque_rate must be positive");
  return found.take();
}

ReactionTask::ReactionTask(std::shared_ptr<const ParallelRobot> robot, const ReactionTaskSettings& settings,
                           const PoseGoalSettings& held)
    : robot_(std::move(robot)), settings_(settings), held_(held) {
  throw_if_any(problems(settings));
}

// ---------------------------------------------------------------- what shall be done

void ReactionTask::classify(const Kinematics& at, const WrenchEstimate& contact,
                            const ContactClassification& touched, const ContactLocation& place,
                            ReactionPlan& plan) const {
  const ContactClasses classes(robot_->body_count(), robot_->legs());
  if (!touched.valid || !touched.accepted || !classes.contains(touched.most_likely) || !at.valid) return;
  if (!contact.valid || !usable(contact.wrench_in_base, robot_->dof())) return;
  const int directions = robot_->space_dimension();
  CartesianVector force = contact.wrench_in_base.head(directions);
  plan.leg = classes.leg(touched.most_likely);
  if (classes.is_clamping(touched.most_likely)) {
    plan.kind = at.joints.passive.size() > plan.leg ? ReactionKind::opening : ReactionKind::brake;
    return;
  }
  const BodyId body = ContactClasses::body(touched.most_likely);
  if (body.is_link1() && robot_->drive_kind(plan.leg) == DriveKind::revolute) {
    const double load = contact.drive_torque.size() > plan.leg ? contact.drive_torque[plan.leg] : 0.0;
    if (!(std::abs(load) >= settings_.load_to_go_by)) return;
    const bool clamps = is_closing(at, plan.leg) && load * at.joints.passive[plan.leg] < 0.0;
    plan.kind = clamps ? ReactionKind::opening : ReactionKind::first_link;
    return;
  }
  if (!body.is_platform()) {
    const bool placed = place.valid && place.body == body.index() && place.force_in_base.size() == directions;
    const double fraction = body.is_link1() ? 1.0 : (placed ? place.fraction : 0.5);
    plan.point_in_body = robot_->axis_point(BodyId::link2(plan.leg), fraction);
    // What friction adds along the link turns round with the sliding: no direction to retreat in.
    force = force_across(at, body, placed ? place.force_in_base : force);
  }
  if (!(force.norm() >= settings_.force_to_go_by)) return;
  plan.kind = body.is_platform() ? ReactionKind::platform : ReactionKind::second_link;
  plan.direction = force.normalized();
  if (body.is_link2() && is_closing(at, plan.leg) && opens_elbow(at, plan.leg, force))
    plan.kind = ReactionKind::opening;
}

void ReactionTask::go_back(const TravelledPath& travelled, const Kinematics& at,
                           const WrenchEstimate& contact, ReactionPlan& plan) const {
  if (!settings_.retreat || !at.valid) return;
  const ConfigurationSpace& space = robot_->space();
  const double reach = largest_reach(at, space.translations());
  const PlatformVector back = travelled.way_back(space, at.pose, settings_.displacement, reach);
  if (back.size() == 0 || !contact.valid || contact.wrench_in_base.size() != space.dimension()) return;
  if (!(force_along(back, contact.wrench_in_base, at) >= least_push * settings_.released_force)) return;
  plan.kind = ReactionKind::retreat;
  plan.way = back;
  plan.from = at.pose;
}

double ReactionTask::force_along(const PlatformVector& way, const PlatformVector& wrench,
                                 const Kinematics& at) const {
  const ConfigurationSpace& space = robot_->space();
  return wrench.dot(way) / farthest_moved(space, way, largest_reach(at, space.translations()));
}

bool ReactionTask::is_pushed_against(Time now, const ReactionPlan& plan, const Kinematics& at,
                                     const Dynamics& model, const WrenchEstimate& contact) const {
  const VectorMotion wanted = plan.motion.evaluate(to_seconds(now - plan.begin));
  if (!at.valid || !model.valid || !wanted.valid) return true;
  if (!contact.valid || contact.wrench_in_base.size() != robot_->dof()) return true;
  const double inertial = std::abs(force_along(plan.way, model.M_x * wanted.acceleration, at));
  const double most = least_push * settings_.released_force + settings_.inertial_share * inertial;
  return !(force_along(plan.way, contact.wrench_in_base, at) > -most);
}

Task ReactionTask::task_of(const ReactionPlan& plan, const Kinematics& at) const {
  const auto narrowed = [&](const Task& task) {
    return settings_.along_force_only ? along(task, plan.direction) : task;
  };
  switch (plan.kind) {
    case ReactionKind::platform:
      return narrowed(platform_position_task(*robot_, at));
    case ReactionKind::second_link:
      return narrowed(point_task(*robot_, at, BodyId::link2(plan.leg), plan.point_in_body));
    case ReactionKind::first_link:
      return drive_task(at, plan.leg);
    case ReactionKind::opening:
      return stacked(drive_task(at, plan.leg), passive_joint_task(at, plan.leg));
    case ReactionKind::retreat: {
      Task task = platform_pose_task(*robot_, at);
      task.sigma = robot_->space().difference(at.pose, plan.from);
      return task;
    }
    case ReactionKind::brake:
      break;
  }
  return no_task(1, robot_->dof());
}

PlatformVector ReactionTask::displacement(const ReactionPlan& plan, const WrenchEstimate& contact) const {
  if (plan.kind == ReactionKind::first_link) {
    const double sign = std::copysign(1.0, contact.drive_torque[plan.leg]);
    return PlatformVector::Constant(1, sign * plan.share() * settings_.first_link_angle);
  }
  if (plan.kind == ReactionKind::opening) return plan.opened * plan.way;
  if (plan.kind == ReactionKind::retreat) return plan.share() * plan.way;
  if (settings_.along_force_only) return PlatformVector::Constant(1, plan.share() * settings_.displacement);
  return plan.share() * settings_.displacement * plan.direction;
}

// ---------------------------------------------------------------- and when

void ReactionTask::move(Time now, const Task& task, const PlatformVector& rate,
                        const PlatformVector& displacement, const Kinematics& at, const Dynamics& model,
                        ReactionPlan& plan) const {
  const PlatformVector direction = displacement.normalized();
  MotionLimits limits = settings_.translation;
  if (plan.moves_joints()) {
    limits = settings_.joint;
    const double fastest = limits.velocity * platform_speed(task, direction, at, model, robot_->space());
    limits = slowed(limits, std::min(1.0, settings_.largest_platform_speed / std::max(fastest, 1e-9)));
  } else if (plan.kind == ReactionKind::retreat) {
    const ConfigurationSpace& space = robot_->space();
    const double fastest = farthest_moved(space, direction, largest_reach(at, space.translations()));
    limits = slowed(limits, 1.0 / fastest);
  }
  if (settings_.drive_share) {
    const double most = largest_acceleration(task, direction, at, model, settings_.max_torque);
    limits.acceleration = *settings_.drive_share * most;
    limits.jerk = most * settings_.max_torque_rate / settings_.max_torque;
  }
  limits.velocity *= plan.share();
  plan.begin = now;
  plan.motion = SynchronisedMotion::plan(task.sigma, rate, task.sigma + displacement, limits);
}

void ReactionTask::begin(Time now, const Kinematics& at, const Dynamics& model, const WrenchEstimate& contact,
                         ReactionPlan& plan) const {
  plan.begin = plan.touched = plan.unpressed = now;
  const Task task = task_of(plan, at);
  if (!task.valid || !model.valid) {
    plan.kind = ReactionKind::brake;
    return;
  }
  const PlatformVector rate = task.rate(at.velocity);
  if (plan.kind == ReactionKind::opening) {
    plan.opened = plan.share() * settings_.opening_angle;
    plan.way = opening_way(at.joints.passive[plan.leg], rate);
  }
  move(now, task, rate, displacement(plan, contact), at, model, plan);
}

bool ReactionTask::feels(const WrenchEstimate& contact) const {
  if (!contact.valid || contact.wrench_in_base.size() != robot_->dof()) return true;
  const int translations = robot_->space().translations();
  const auto forces = contact.wrench_in_base.head(translations).array().abs();
  const auto moments = contact.wrench_in_base.tail(robot_->dof() - translations).array().abs();
  return (forces >= settings_.released_force).any() || (moments >= settings_.released_moment).any();
}

bool ReactionTask::has_arrived(Time now, const ReactionPlan& plan) const {
  return to_seconds(now - plan.begin) >= plan.motion.duration();
}

void ReactionTask::travel(Time now, const ReactionState& state, const Kinematics& at,
                          TravelledPath& path) const {
  if (state.mode == ReactionMode::nominal && at.valid) path.add(now, state.since, at.pose);
}

void ReactionTask::plan(Time now, const ReactionPlan& last, const TravelledPath& travelled,
                        const ReactionState& state, const Kinematics& at, const Dynamics& model,
                        const WrenchEstimate& contact, const ContactClassification& touched,
                        const ContactLocation& place, ReactionPlan& next) const {
  const Time decided = state.since + settings_.decide_within;
  const bool begins = state.entered(ReactionMode::react, now) && state.previous != ReactionMode::hold;
  if (begins || (last.is_open() && state.mode == ReactionMode::react && now <= decided)) {
    next = ReactionPlan();
    if (!begins) next.attempts = std::max(last.attempts, 1);
    classify(at, contact, touched, place, next);
    const bool goes_on = !begins && last.kind == ReactionKind::retreat && next.kind == ReactionKind::brake &&
                         !is_pushed_against(now, last, at, model, contact);
    if (!goes_on) {
      if (next.kind == ReactionKind::brake) go_back(travelled, at, contact, next);
      begin(now, at, model, contact, next);
      if (next.kind == ReactionKind::brake) next.begin = decided;
      return;
    }
  }
  next = last;
  const bool felt = feels(contact), is_free = !felt && now - last.touched >= settings_.released_for;
  next.released = last.released || is_free;
  if (is_free && last.holds()) next.attempts = 0;
  if (felt) next.touched = now;
  if (!is_reacting(state.mode) || !at.valid || !model.valid) return;
  const bool opens = next.kind == ReactionKind::opening && next.opened < settings_.largest_opening;
  if (opens && has_arrived(now, next) && !next.released &&
      !opposes(task_of(next, at), next.way, Eigen::Vector2d::Zero(), model, contact)) {
    next.unpressed = now;
    if (felt) open_further(now, at, model, next);
    return;
  }
  if (!presses(now, next, at, model, contact)) {
    next.unpressed = now;
  } else if (now - next.unpressed >= settings_.pressed_for) {
    next = decided_anew(now, next, travelled, at, model, contact, touched, place);
  }
  if (!next.holds() && has_given_way(now, next)) come_to_rest(now, at, next);
}

ReactionPlan ReactionTask::decided_anew(Time now, const ReactionPlan& last, const TravelledPath& travelled,
                                        const Kinematics& at, const Dynamics& model,
                                        const WrenchEstimate& contact, const ContactClassification& touched,
                                        const ContactLocation& place) const {
  ReactionPlan next;
  classify(at, contact, touched, place, next);
  next.attempts = last.attempts + 1;
  if (next.attempts > ReactionPlan::most_attempts) {
    next.kind = ReactionKind::brake;
  } else if (next.kind == ReactionKind::opening && next.leg == last.leg && last.opened > 0.0) {
    if (last.kind == ReactionKind::opening && !has_arrived(now, last)) {
      next = last;
      next.unpressed = now;
      return next;
    }
    next.kind = ReactionKind::brake;
    next.opened = last.opened;
  } else if (next.kind == ReactionKind::brake && !last.over) {
    go_back(travelled, at, contact, next);
  }
  begin(now, at, model, contact, next);
  return next;
}

bool ReactionTask::presses(Time now, const ReactionPlan& plan, const Kinematics& at, const Dynamics& model,
                           const WrenchEstimate& contact) const {
  if (!feels(contact)) return false;
  if (has_arrived(now, plan)) return true;
  const Task task = task_of(plan, at);
  const VectorMotion wanted = plan.motion.evaluate(to_seconds(now - plan.begin));
  return opposes(task, error_of(plan, task, plan.motion.goal()), wanted.acceleration, model, contact);
}

bool ReactionTask::opposes(const Task& task, const PlatformVector& ahead, const PlatformVector& acceleration,
                           const Dynamics& model, const WrenchEstimate& contact) const {
  if (!task.valid || !contact.valid || contact.wrench_in_base.size() != robot_->dof()) return false;
  const PlatformMatrix mobility = inverse(model.M_x);
  const PlatformVector v = least_motion(task, ahead, mobility);
  const PlatformVector inertial_force = model.M_x * least_motion(task, acceleration, mobility);
  return v.dot(contact.wrench_in_base) < -settings_.inertial_share * std::abs(v.dot(inertial_force));
}

void ReactionTask::open_further(Time now, const Kinematics& at, const Dynamics& model,
                                ReactionPlan& plan) const {
  const double step = std::min(settings_.opening_step, settings_.largest_opening - plan.opened);
  plan.opened += step;
  Task task = task_of(plan, at);
  task.sigma = plan.motion.goal();
  move(now, task, Eigen::Vector2d::Zero(), step * plan.way, at, model, plan);
}

bool ReactionTask::has_given_way(Time now, const ReactionPlan& plan) const {
  const bool until_released = plan.kind == ReactionKind::opening || plan.kind == ReactionKind::brake;
  const bool opened = plan.kind == ReactionKind::opening && plan.opened >= settings_.largest_opening;
  return (!until_released || plan.released || opened) && has_arrived(now, plan);
}

void ReactionTask::come_to_rest(Time now, const Kinematics& at, ReactionPlan& plan) const {
  if (!plan.over) plan.over = now;
  const bool rests = (at.rates.active.array().abs() < settings_.rest_speed).all();
  if (rests || now - *plan.over >= settings_.longest_braking) plan.held = at.pose;
}

// ---------------------------------------------------------------- what follows from it at a tick

void ReactionTask::lead(Time now, const ReactionPlan& plan, const Kinematics& at, TaskList& list) const {
  list.count = 0;
  list.valid = at.valid;
  if (!at.valid) return;
  if (plan.holds()) {
    const PlatformVector rest = PlatformVector::Zero(robot_->dof());
    add_pose_goals(*robot_, held_, {true, true, plan.held, rest, rest}, at, list);
    return;
  }
  const Task task = task_of(plan, at);
  const VectorMotion wanted = plan.motion.evaluate(to_seconds(now - plan.begin));
  if (plan.kind == ReactionKind::retreat && wanted.valid) {
    const PlatformReference pose =
        chart_motion(robot_->space(), plan.from, wanted.position, wanted.velocity, wanted.acceleration);
    return add_pose_goals(*robot_, held_, pose, at, list);
  }
  if (!task.valid || !wanted.valid || wanted.position.size() != task.rows()) return;
  const PlatformVector error = error_of(plan, task, wanted.position);
  const TaskGoal goal{task, {error, wanted.velocity, wanted.acceleration}, gains_of(plan, task.rows())};
  if (plan.kind == ReactionKind::opening && settings_.opening_by_priority) return list.add_rows(goal);
  list.add(goal);
}

PlatformVector ReactionTask::error_of(const ReactionPlan& plan, const Task& task,
                                      const PlatformVector& wanted) const {
  const PlatformVector error = wanted - task.sigma;
  if (!plan.moves_joints() || robot_->drive_kind(plan.leg) != DriveKind::revolute) return error;
  return error.unaryExpr([](double angle) { return wrap_angle(angle); });
}

void ReactionTask::follow(Time now, const ReactionPlan& plan, const Kinematics& at,
                          PlatformReference& followed) const {
  const PlatformVector rest = PlatformVector::Zero(robot_->dof());
  const bool rests = plan.kind == ReactionKind::brake ? has_arrived(now, plan) : plan.holds();
  followed = {at.valid, at.valid && rests, at.pose, rest, rest};
}

void ReactionTask::tell(const ReactionState& state, const ReactionPlan& plan, FollowedTask& told) const {
  const bool leads_leg = plan.moves_joints() || plan.kind == ReactionKind::second_link;
  told = {is_reacting(state.mode), plan.kind, leads_leg ? plan.leg : -1};
}

TaskGains ReactionTask::gains_of(const ReactionPlan& plan, int rows) const {
  const TaskGains& one = plan.kind == ReactionKind::platform      ? settings_.platform
                         : plan.kind == ReactionKind::second_link ? settings_.second_link
                         : plan.kind == ReactionKind::first_link  ? settings_.first_link
                                                                  : settings_.opening;
  return one.for_rows(rows);
}

}  // namespace flinch
