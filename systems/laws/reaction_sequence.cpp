#include "systems/laws/reaction_sequence.h"

#include "systems/foundation/setup_error.h"

namespace flinch {

ReactionMode next_mode(ReactionMode mode, const ReactionEvents& events) noexcept {
  using enum ReactionMode;
  if (events.recovering) return recover;
  if (!events.gate_open) return stopped;
  if (events.struck) return zero_g;
  switch (mode) {
    case stopped:
    case recover:
      return nominal;
    case nominal:
      return events.touched ? react : nominal;
    case react:
      return events.arrived ? hold : react;
    case hold:
      if (events.reset) return nominal;
      return events.goes_on ? react : hold;
    case zero_g:
      return events.reset && events.quiet ? nominal : zero_g;
  }
  return stopped;
}

ReactionSequence::ReactionSequence(const ReactionSequenceSettings& settings) : settings_(settings) {
  if (!(settings.rest_speed > 0)) throw SetupError("reaction sequence: rest_speed must be positive");
}

ReactionState ReactionSequence::advance(Time now, const ReactionState& last, bool arrived, bool goes_on,
                                        GatePhase phase, const ContactDetection& contact,
                                        const JointMotion& motion, const ResetCommand& command) const {
  const ContactLevel level = contact.valid ? contact.present_level : ContactLevel::none;
  const ReactionEvents events{.gate_open = phase == GatePhase::open,
                              .touched = level != ContactLevel::none,
                              .struck = level == ContactLevel::hard && settings_.zero_g_when_struck,
                              .arrived = arrived,
                              .goes_on = goes_on,
                              .quiet = is_quiet(contact, motion),
                              .reset = command.reset,
                              .recovering = phase == GatePhase::recovering};
  const ReactionMode mode = next_mode(last.mode, events);
  return mode == last.mode ? last : ReactionState{mode, last.mode, now};
}

bool ReactionSequence::is_quiet(const ContactDetection& contact, const JointMotion& motion) const {
  const bool free = contact.valid && contact.present_level == ContactLevel::none;
  return free && motion.rests(settings_.rest_speed);
}

}  // namespace flinch
