#pragma once

#include <cstdint>

#include "systems/framework/system.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/torque_command.h"

namespace flinch {

struct ModeSelectorSettings {
  Time blend = 10ms;            ///< from one law to the next, 0 for none
  bool reacts_at_once = false;  ///< the reacting law is followed by the largest rate instead of a blend
  /// By which the torque of a drive changes at most from law to law [Nm/s or N/s].
  double max_torque_rate = 20e3;
};

/// Hands on the torques of the mode that the reaction sequence is in:
///
///   nominal, recover   those of the nominal law
///   react, hold        of the reaction law
///   zero_g             of yielding to a hard contact
///   stopped            those that the drives are told; where they are told none, of zero gravity
///
/// At a change of the law it blends, tau = (1 - w) tau_old + w tau_new, where w grows by tick / blend at
/// every tick and is one such step at the first. The old law goes on being evaluated, unless it has no valid
/// torques or was itself still being blended in: then its last torques are frozen, as are those of a stop
/// once it is over. So whatever follows a stop goes on from what the drives do. Torques that would change too
/// fast in a blend follow by the largest rate, in the direction of the change, until they have caught up; so
/// do those of a reaction that begins at once. Not valid where the new law is not.
class ModeSelector final : public System {
 public:
  enum class Law : std::uint8_t { zero_gravity, nominal, reacting, yielding, stopping };

  /// How far the change from one law to the next has come.
  struct Blend {
    Time tick{};  ///< at which this was so
    Law from = Law::zero_gravity;
    Law to = Law::zero_gravity;
    Time progress = 1h;    ///< of the change
    double weight = 1.0;   ///< w, of `to`
    bool frozen = false;   ///< blending from `held` instead of the torques of `from`
    JointVector held;      ///< [Nm]; empty for no torques
    TorqueCommand torque;  ///< what is handed on
    bool behind = false;   ///< what was blended, as it would have changed too fast
  };

 private:
  State<Blend> last_ = state<Blend>("last");
  State<TorqueCommand> told_ = state<TorqueCommand>("told");

 public:
  /// Throws SetupError for a negative time, or a rate that is not positive.
  explicit ModeSelector(const ModeSelectorSettings& settings = {});

  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<TorqueCommand> nominal = input<TorqueCommand>("nominal");
  InputPort<TorqueCommand> reacting = input<TorqueCommand>("reacting");
  InputPort<TorqueCommand> yielding = input<TorqueCommand>("yielding");
  InputPort<TorqueCommand> zero_gravity = input<TorqueCommand>("zero_gravity");
  InputPort<TorqueCommand> commanded = input<TorqueCommand>("commanded");  ///< what the drives are told
  InputPort<PlatformReference> nominal_reference = input<PlatformReference>("nominal_reference");
  InputPort<PlatformReference> reaction_reference = input<PlatformReference>("reaction_reference");

 private:
  Intermediate<Blend> blend_ = intermediate<&ModeSelector::blend>("blend", clock, last_, told_, reaction,
                                                                  nominal, reacting, yielding, zero_gravity);

 public:
  OutputPort<TorqueCommand> torque = output<&ModeSelector::torque_of>("torque", blend_);
  /// The reference that is being followed; not valid where none is.
  OutputPort<PlatformReference> reference =
      output<&ModeSelector::select>("reference", reaction, nominal_reference, reaction_reference);

 private:
  Update remember_ = keep(last_, blend_);
  Update tell_ = update<&ModeSelector::as_told>(told_, commanded);

  Blend advanced(Time now, const Blend& last, Law wanted) const;
  void hold_back(const Blend& last, Blend& next) const;
  void blend(Time now, const Blend& last, const TorqueCommand& told, const ReactionState& state,
             const TorqueCommand& nominal_law, const TorqueCommand& reaction_law,
             const TorqueCommand& yielding_law, const TorqueCommand& gravity_law, Blend& next) const;
  TorqueCommand torque_of(const Blend& now) const { return now.torque; }
  TorqueCommand as_told(const TorqueCommand& command) const { return command; }
  PlatformReference select(const ReactionState& state, const PlatformReference& nominal_motion,
                           const PlatformReference& reaction_motion) const;

  ModeSelectorSettings settings_;
};

}  // namespace flinch
