#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "systems/framework/system.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/target_command.h"

namespace flinch {

/// What an operator does once, and when.
struct OperatorEvent {
  enum class After : std::uint8_t {
    time,        ///< at a time of the run
    ended,       ///< the robot rests in `hold` or `zero_g`, or where the gate has closed
    recovering,  ///< the mode is `recover`; left out where it is `nominal`: there is no need to come back
    arrived,     ///< the mode is `nominal` and the reference at rest
  };
  After after = After::time;
  Time wait{};              ///< since the start of the run, or since that is so without interruption
  OperatorCommand buttons;  ///< that are down for one tick
  TargetCommand target;     ///< of no kind: none; its number does not count
};

struct OperatorScript {
  /// In their order; empty: nobody does anything.
  std::vector<OperatorEvent> events;
  double rest_speed = 0.05;  ///< below it a drive counts as at rest [rad/s or m/s]
};

/// Does what a script says, and hands on what somebody at a panel does.
///
/// One event follows the other, with a tick between them. Where the robot has ended again, as after a second
/// contact or a reset without effect, the script goes on with its first event after that. What the robot
/// does it learns one tick later.
///
/// A button is down where panel or script has it down; of two targets at one tick that of the panel counts.
/// From the tick on at which the panel's stop is down the script does nothing more: who stops the robot by
/// hand will not have it go on by itself.
class ScriptedOperator final : public System {
 public:
  /// Whether something is so, and the first tick at which it was.
  struct Since {
    bool is_so = false;
    Time begin{};
  };
  /// How far the script is, and what reaches the control path.
  struct Course {
    std::size_t next = 0;    ///< event
    Since awaited;           ///< what that event waits for
    Since ended;             ///< the robot has, again
    bool has_acted = false;  ///< at the tick before
    bool is_silent = false;  ///< the panel has stopped the robot
    std::uint32_t panel_target = 0;
    OperatorCommand buttons;
    TargetCommand target;
  };

 private:
  State<Course> last_ = state<Course>("last");
  State<ReactionMode> mode_ = state<ReactionMode>("mode", ReactionMode::stopped);
  State<GatePhase> phase_ = state<GatePhase>("phase", GatePhase::waiting);
  State<bool> finished_ = state<bool>("finished", false);

 public:
  /// Throws SetupError for a rest speed that is not positive.
  explicit ScriptedOperator(OperatorScript script);

  InputPort<OperatorCommand> panel = input<OperatorCommand>("panel");
  InputPort<TargetCommand> panel_target = input<TargetCommand>("panel_target");
  InputPort<JointMotion> joints = input<JointMotion>("joints");
  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<GateStatus> gate = input<GateStatus>("gate");
  InputPort<PlatformReference> reference = input<PlatformReference>("reference");

 private:
  Intermediate<Course> course_ = intermediate<&ScriptedOperator::advance>(
      "course", clock, last_, mode_, phase_, finished_, joints, panel, panel_target);

 public:
  OutputPort<OperatorCommand> buttons = output<&ScriptedOperator::buttons_of>("buttons", course_);
  OutputPort<TargetCommand> target = output<&ScriptedOperator::target_of>("target", course_);

 private:
  Update remember_ = keep(last_, course_);
  Update note_mode_ = update<&ScriptedOperator::mode_of>(mode_, reaction);
  Update note_phase_ = update<&ScriptedOperator::phase_of>(phase_, gate);
  Update note_finished_ = update<&ScriptedOperator::is_finished>(finished_, reference);

  void advance(Time now, const Course& last, ReactionMode mode, GatePhase phase, bool finished,
               const JointMotion& motion, const OperatorCommand& pressed, const TargetCommand& wanted,
               Course& course) const;
  OperatorCommand buttons_of(const Course& course) const { return course.buttons; }
  TargetCommand target_of(const Course& course) const { return course.target; }
  ReactionMode mode_of(const ReactionState& state) const { return state.mode; }
  GatePhase phase_of(const GateStatus& status) const { return status.phase; }
  bool is_finished(const PlatformReference& wanted) const { return wanted.valid && wanted.finished; }

  OperatorScript script_;
  std::size_t after_end_;  ///< the first event after an end; as many as there are: none
};

}  // namespace flinch
