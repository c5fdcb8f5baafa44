#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "systems/framework/never_allocates.h"
#include "systems/framework/system.h"
#include "systems/motion/pose_goal_settings.h"
#include "systems/motion/reaction_task_settings.h"
#include "systems/motion/synchronised_motion.h"
#include "systems/motion/travelled_path.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/followed_task.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/task_list.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// What was decided when the reaction began, and how far it has come.
struct ReactionPlan {
  static constexpr int most_attempts = 3;  ///< to give way; whoever is pressed after them is braked

  ReactionKind kind = ReactionKind::brake;
  int leg = -1;                   ///< of a link or clamping
  CartesianVector point_in_body;  ///< of the second link that moves
  CartesianVector direction;      ///< of the force; empty where both directions are a task
  PlatformVector way;         ///< of the two joints of a leg that opens, for 1 rad of `opened`; of a retreat
  Configuration from;         ///< pose at which a retreat begins
  SynchronisedMotion motion;  ///< of the task
  Time begin{};               ///< of that motion; of braking, when it is decided that nothing else follows
  double opened = 0.0;        ///< planned opening of the first link [rad]
  Time touched{};             ///< tick at which a force was last felt
  bool released = false;      ///< an opening: nothing was felt for long enough, once
  Time unpressed{};           ///< tick at which the robot last did not press against what it feels
  int attempts = 1;           ///< to give way, in a row, of which each was pressed but perhaps the last
  std::optional<Time> over;   ///< tick at which the motion was
  Configuration held;         ///< place that is held after it; empty until the robot rests

  bool holds() const { return held.size() != 0; }
  /// What was touched was not known, and may be told yet.
  bool is_open() const {
    return (kind == ReactionKind::brake || kind == ReactionKind::retreat) && attempts <= most_attempts;
  }
  bool moves_joints() const { return kind == ReactionKind::first_link || kind == ReactionKind::opening; }
  /// Of the speed and the way of a reaction, by how often it was pressed.
  double share() const { return std::ldexp(1.0, 1 - attempts); }
};

template <>
inline constexpr bool never_allocates<ReactionPlan> =
    never_allocates<CartesianVector>&& never_allocates<PlatformVector>&& never_allocates<Configuration>;

/// Gives way to a contact as its class asks for: at the tick at which the reaction begins class, place,
/// direction of the force and leg are frozen, and a jerk-limited motion of the task of that class is planned
/// from how it moves now. An opening that has arrived goes on by `opening_step` where a force is still felt
/// that does not oppose it, up to the largest opening; once released, it is over. [SafePR] IV-C, Alg. 5
///
/// When that is over and the robot rests, or does not within `longest_braking`, its goal is given up, for a
/// limit or a contact may have kept the robot from it: its place is held, position before orientation. A
/// robot that is only braked yields until nothing was felt for `released_for`, and then holds its place.
/// (Derived.)
///
/// A drive that slides does not turn the first link of its leg. Touched there, the leg gives way by its far
/// end, which moves along the force as far as it acts across the leg: what is touched goes the same way, less
/// far. (Derived.)
///
/// A link of a leg that closes, touched from between its links, is answered by opening too. What is still
/// felt after the motion, or lies on its way, is given way to anew, half as far and half as fast. Whoever is
/// pressed again after two such times is only braked: between two things a robot would drive itself to and
/// fro. The count ends where a place is held and nothing was felt for `released_for`. (Derived.)
///
/// Where the class is not accepted, or the force has no direction yet, the platform goes straight back to
/// where it was `displacement` before, if what it feels pushes it there: it has run into something, and was
/// free of it there, whatever was touched. Otherwise the list has no task: the robot is braked. For
/// `decide_within` after the detection it may still be decided, and whoever is pushed against his way back,
/// or does not know by what, is braked. When the motion is over nobody goes back. (Derived.)
/// Displacements of legs are opposite to those printed, which press a first link against what it clamps.
class ReactionTask final : public System {
  State<ReactionPlan> last_ = state<ReactionPlan>("last");
  State<TravelledPath> travelled_ = state<TravelledPath>("travelled");

 public:
  /// `held`: how strongly a place is held. Throws SetupError for settings that have `problems`.
  ReactionTask(std::shared_ptr<const ParallelRobot> robot, const ReactionTaskSettings& settings,
               const PoseGoalSettings& held = {});

  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<WrenchEstimate> estimate = input<WrenchEstimate>("estimate");
  InputPort<ContactClassification> classification = input<ContactClassification>("classification");
  InputPort<ContactLocation> location = input<ContactLocation>("location");

 private:
  Intermediate<ReactionPlan> plan_ = intermediate<&ReactionTask::plan>(
      "plan", clock, last_, travelled_, reaction, kinematics, dynamics, estimate, classification, location);

 public:
  OutputPort<TaskList> goals = output<&ReactionTask::lead>("goals", clock, plan_, kinematics);
  OutputPort<ReactionKind> kind = output<&ReactionTask::kind_of>("kind", plan_);
  OutputPort<FollowedTask> followed_task = output<&ReactionTask::tell>("followed_task", reaction, plan_);
  /// `finished` when it holds a place; where there is nothing to give way to, when that is decided. Tasks
  /// leave part of the pose free, and constraints come before a place that is held: the pose is the measured
  /// one.
  OutputPort<PlatformReference> reference =
      output<&ReactionTask::follow>("reference", clock, plan_, kinematics);

 private:
  Update remember_ = keep(last_, plan_);
  Update travel_ = update<&ReactionTask::travel>(travelled_, clock, reaction, kinematics);

  void travel(Time now, const ReactionState& state, const Kinematics& at, TravelledPath& path) const;
  void plan(Time now, const ReactionPlan& last, const TravelledPath& travelled, const ReactionState& state,
            const Kinematics& at, const Dynamics& model, const WrenchEstimate& contact,
            const ContactClassification& touched, const ContactLocation& place, ReactionPlan& next) const;
  void lead(Time now, const ReactionPlan& plan, const Kinematics& at, TaskList& list) const;
  ReactionKind kind_of(const ReactionPlan& plan) const { return plan.kind; }
  void tell(const ReactionState& state, const ReactionPlan& plan, FollowedTask& told) const;
  void follow(Time now, const ReactionPlan& plan, const Kinematics& at, PlatformReference& followed) const;

  /// Decides about kind, leg, point and direction.
  void classify(const Kinematics& at, const WrenchEstimate& contact, const ContactClassification& touched,
                const ContactLocation& place, ReactionPlan& plan) const;
  /// Decides about what is not known.
  void go_back(const TravelledPath& travelled, const Kinematics& at, const WrenchEstimate& contact,
               ReactionPlan& plan) const;
  /// Work of `wrench` on `way`, by the length of that [N].
  double force_along(const PlatformVector& way, const PlatformVector& wrench, const Kinematics& at) const;
  /// What is felt pushes against the way of a retreat, by more than its own acceleration makes the robot feel
  /// where its model is a little wrong; or is not known.
  bool is_pushed_against(Time now, const ReactionPlan& plan, const Kinematics& at, const Dynamics& model,
                         const WrenchEstimate& contact) const;
  void begin(Time now, const Kinematics& at, const Dynamics& model, const WrenchEstimate& contact,
             ReactionPlan& plan) const;
  /// Plans from `task`, moving with `rate`.
  void move(Time now, const Task& task, const PlatformVector& rate, const PlatformVector& displacement,
            const Kinematics& at, const Dynamics& model, ReactionPlan& plan) const;
  Task task_of(const ReactionPlan& plan, const Kinematics& at) const;
  PlatformVector displacement(const ReactionPlan& plan, const WrenchEstimate& contact) const;
  bool feels(const WrenchEstimate& contact) const;
  bool has_arrived(Time now, const ReactionPlan& plan) const;
  ReactionPlan decided_anew(Time now, const ReactionPlan& last, const TravelledPath& travelled,
                            const Kinematics& at, const Dynamics& model, const WrenchEstimate& contact,
                            const ContactClassification& touched, const ContactLocation& place) const;
  /// What is felt stays, or the motion leads into it.
  bool presses(Time now, const ReactionPlan& plan, const Kinematics& at, const Dynamics& model,
               const WrenchEstimate& contact) const;
  /// What is felt does negative work where the task moves along `ahead`, beyond what a task that accelerates
  /// so makes the robot feel.
  bool opposes(const Task& task, const PlatformVector& ahead, const PlatformVector& acceleration,
               const Dynamics& model, const WrenchEstimate& contact) const;
  void open_further(Time now, const Kinematics& at, const Dynamics& model, ReactionPlan& plan) const;
  /// The motion has arrived, and a leg that opened, or a robot that was only braked, is released.
  bool has_given_way(Time now, const ReactionPlan& plan) const;
  /// Decides about the place that is held.
  void come_to_rest(Time now, const Kinematics& at, ReactionPlan& plan) const;
  PlatformVector error_of(const ReactionPlan& plan, const Task& task, const PlatformVector& wanted) const;
  TaskGains gains_of(const ReactionPlan& plan, int rows) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ReactionTaskSettings settings_;
  PoseGoalSettings held_;
};

}  // namespace flinch
