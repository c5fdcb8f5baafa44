#pragma once

#include "systems/framework/system.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/reset_command.h"

namespace flinch {

/// All that can move the reaction sequence on, at one tick.
struct ReactionEvents {
  bool gate_open = false;   ///< the torque gate lets torques through
  bool touched = false;     ///< a contact reaches the reaction threshold now
  bool struck = false;      ///< a contact reaches the hard threshold now
  bool arrived = false;     ///< the reaction motion has come to rest
  bool goes_on = false;     ///< it moves
  bool quiet = false;       ///< known to be free of contact and nearly at rest
  bool reset = false;       ///< the operator asks for it
  bool recovering = false;  ///< the torque gate lets reduced torques through, for the way back inside
};

/// The state machine of [SafePR] Alg. 5, extended by what the torque gate does:
///
///   from \ event  recovering  gate closed  struck  touched  arrived  reset            goes on  gate open
///   stopped       recover     .            zero_g  .        .        .                .        nominal
///   nominal       recover     stopped      zero_g  react    .        .                .        .
///   react         recover     stopped      zero_g  .        hold     .                .        .
///   hold          recover     stopped      zero_g  .        .        nominal          react    .
///   zero_g        recover     stopped      .       .        .        nominal if quiet .        .
///   recover       .           stopped      zero_g  .        .        .                .        nominal
///
/// Columns to the left win. A contact in a recovery is a fault: the estimate may not be good enough there to
/// give way by it. Nothing resumes by itself: a reaction ends only by reset, and the gate, once it
/// has closed, opens only by reset.
ReactionMode next_mode(ReactionMode mode, const ReactionEvents& events) noexcept;

struct ReactionSequenceSettings {
  bool zero_g_when_struck = true;  ///< contacts at the hard threshold lead to zero gravity
  double rest_speed = 0.05;        ///< below it a drive counts as at rest [rad/s]
};

/// Runs the reaction sequence. It acts on a contact at the tick of its detection; that the reaction motion
/// has arrived, and what the gate did, it learns one tick later.
class ReactionSequence final : public System {
  State<ReactionState> last_ = state<ReactionState>("last");
  State<bool> arrived_ = state<bool>("arrived", false);
  State<bool> goes_on_ = state<bool>("goes_on", false);
  State<GatePhase> gate_ = state<GatePhase>("gate", GatePhase::waiting);

 public:
  /// Throws SetupError for a rest speed that is not positive.
  explicit ReactionSequence(const ReactionSequenceSettings& settings);

  InputPort<ContactDetection> detection = input<ContactDetection>("detection");
  InputPort<JointMotion> joints = input<JointMotion>("joints");
  InputPort<PlatformReference> reaction = input<PlatformReference>("reaction");  ///< the reaction motion
  InputPort<GateStatus> gate = input<GateStatus>("gate");
  InputPort<ResetCommand> reset = input<ResetCommand>("reset");

  OutputPort<ReactionState> reaction_state = output<&ReactionSequence::advance>(
      "state", clock, last_, arrived_, goes_on_, gate_, detection, joints, reset);

 private:
  Update remember_ = keep(last_, reaction_state);
  Update arrive_ = update<&ReactionSequence::has_arrived>(arrived_, reaction);
  Update go_on_ = update<&ReactionSequence::moves>(goes_on_, reaction);
  Update open_ = update<&ReactionSequence::phase_of>(gate_, gate);

  ReactionState advance(Time now, const ReactionState& last, bool arrived, bool goes_on, GatePhase phase,
                        const ContactDetection& contact, const JointMotion& motion,
                        const ResetCommand& command) const;
  bool has_arrived(const PlatformReference& retreat) const { return retreat.valid && retreat.finished; }
  bool moves(const PlatformReference& retreat) const { return retreat.valid && !retreat.finished; }
  GatePhase phase_of(const GateStatus& status) const { return status.phase; }
  bool is_quiet(const ContactDetection& contact, const JointMotion& motion) const;

  ReactionSequenceSettings settings_;
};

}  // namespace flinch
