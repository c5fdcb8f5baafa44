#pragma once

#include <cstdint>
#include <memory>

#include "systems/framework/system.h"
#include "systems/motion/constraint_settings.h"
#include "systems/motion/jerk_limited_profile.h"
#include "systems/robot/constraint_tasks.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/constraint_state.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/task_list.h"

namespace flinch {

/// Watches over condition number and self-collision, [SafePR] Alg. 3 and 4: a measure that leaves the range
/// of its activation value becomes a task before all others. Its reference glides from where it is measured
/// to the safety value and stays there, so that the measure is led to its limit and not stopped by it. It is
/// let go when it has been inside its activation value for the dwell.
///
/// In hold no measure is led to its limit any more: one that is inside its safety value when hold begins, or
/// when it leaves the range of its activation value in hold, is kept where it is then. Nor is it let go:
/// where the place that is held draws the robot out of that range, it would become active again and again. A
/// reaction that is taken up anew leads it on from there. (Derived.)
///
/// It watches in the modes that it was made for. Where the kinematics is not valid nothing is active.
class ConstraintMonitor final : public System {
 public:
  /// The reference of one measure.
  struct Glide {
    bool active = false;
    JerkLimitedProfile profile;
    Time begin{};
    Time outside{};  ///< tick at which it was last outside its activation value
  };
  struct Memory {
    Glide sigma_kappa;
    Glide sigma_sc;
    ConstraintMode mode = ConstraintMode::none;
    Time since{};
  };
  /// Both measures as tasks.
  struct Measures {
    Task sigma_kappa;
    Task sigma_sc;
    double kappa_rate = 0.0;
    double sc_rate = 0.0;
  };
  /// Of which law it is part.
  enum class Role : std::uint8_t { nominal, reacting };

 private:
  State<Memory> last_ = state<Memory>("last");

 public:
  /// Throws SetupError for settings that have `problems`.
  ConstraintMonitor(std::shared_ptr<const ParallelRobot> robot, const ConstraintSettings& settings,
                    Role role);

  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");

 private:
  Intermediate<Measures> measures_ = intermediate<&ConstraintMonitor::measure>("measures", kinematics);
  Intermediate<Memory> memory_ =
      intermediate<&ConstraintMonitor::advance>("memory", clock, last_, reaction, measures_);

 public:
  OutputPort<ConstraintState> constraints =
      output<&ConstraintMonitor::tell>("constraints", clock, reaction, measures_, memory_);
  /// sigma_kappa, then sigma_sc, whether they are active or not.
  OutputPort<TaskList> goals = output<&ConstraintMonitor::lead>("goals", clock, measures_, memory_);

 private:
  Update remember_ = keep(last_, memory_);

  void measure(const Kinematics& now, Measures& measures) const;
  void advance(Time now, const Memory& last, const ReactionState& state, const Measures& measures,
               Memory& next) const;
  ConstraintState tell(Time now, const ReactionState& state, const Measures& measures,
                       const Memory& memory) const;
  void lead(Time now, const Measures& measures, const Memory& memory, TaskList& list) const;
  bool watches(const ReactionState& state) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ConstraintSettings settings_;
  Role role_;
};

}  // namespace flinch
