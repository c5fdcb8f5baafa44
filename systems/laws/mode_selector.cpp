#include "systems/laws/mode_selector.h"

#include "systems/foundation/setup_error.h"
#include "systems/laws/share_within.h"

namespace flinch {
namespace {

using Law = ModeSelector::Law;

Law law_of(ReactionMode mode, bool is_stopping) {
  switch (mode) {
    case ReactionMode::nominal:
    case ReactionMode::recover:
      return Law::nominal;
    case ReactionMode::react:
    case ReactionMode::hold:
      return Law::reacting;
    case ReactionMode::zero_g:
      return Law::yielding;
    case ReactionMode::stopped:
      break;
  }
  return is_stopping ? Law::stopping : Law::zero_gravity;
}

/// Goes on from the torques that were last handed on, if there were any.
void freeze(ModeSelector::Blend& blend, const TorqueCommand& last) {
  blend.frozen = true;
  blend.held = last.valid ? last.torque : JointVector();
}

TorqueCommand mixed(const JointVector& old, double weight, const TorqueCommand& wanted) {
  TorqueCommand torque = wanted;
  torque.torque *= weight;
  if (weight < 1.0 && old.size() == torque.torque.size()) torque.torque += (1.0 - weight) * old;
  torque.valid = wanted.valid && torque.torque.allFinite();
  return torque;
}

}  // namespace

ModeSelector::ModeSelector(const ModeSelectorSettings& settings) : settings_(settings) {
  if (settings.blend < Time::zero()) throw SetupError("mode selector: blend must not be negative");
  if (!(settings.max_torque_rate > 0)) throw SetupError("mode selector: max_torque_rate must be positive");
}

ModeSelector::Blend ModeSelector::advanced(Time now, const Blend& last, Law wanted) const {
  Blend next = last;
  if (wanted != last.to) {
    next.from = last.to;
    next.to = wanted;
    next.progress = Time::zero();
    next.frozen = false;
    if (last.weight < 1.0 || last.to == Law::stopping) freeze(next, last.torque);
    if (wanted == Law::stopping) next.progress = settings_.blend;
    if (wanted == Law::reacting && settings_.reacts_at_once) {
      next.progress = settings_.blend;
      next.behind = true;
    }
  }
  next.tick = now;
  next.progress += now - last.tick;
  const bool done = next.progress >= settings_.blend;
  next.weight = done ? 1.0 : to_seconds(next.progress) / to_seconds(settings_.blend);
  return next;
}

void ModeSelector::blend(Time now, const Blend& last, const TorqueCommand& told, const ReactionState& state,
                         const TorqueCommand& nominal_law, const TorqueCommand& reaction_law,
                         const TorqueCommand& yielding_law, const TorqueCommand& gravity_law,
                         Blend& next) const {
  const auto torque_of = [&](Law law) -> const TorqueCommand& {
    switch (law) {
      case Law::nominal:
        return nominal_law;
      case Law::reacting:
        return reaction_law;
      case Law::yielding:
        return yielding_law;
      case Law::stopping:
        return told;
      case Law::zero_gravity:
        break;
    }
    return gravity_law;
  };
  next = advanced(now, last, law_of(state.mode, told.valid));
  if (!next.frozen && !torque_of(next.from).valid) freeze(next, last.torque);
  const JointVector& old = next.frozen ? next.held : torque_of(next.from).torque;
  next.torque = mixed(old, next.weight, torque_of(next.to));
  hold_back(last, next);
}

void ModeSelector::hold_back(const Blend& last, Blend& next) const {
  const bool follows = next.weight < 1.0 || last.weight < 1.0 || next.behind;
  next.behind = false;
  if (next.to == Law::stopping) return;
  const JointVector& before = last.torque.torque;
  if (!follows || !last.torque.valid || before.size() != next.torque.torque.size()) return;
  const JointVector change = next.torque.torque - before;
  const double share = share_within(change, settings_.max_torque_rate * to_seconds(next.tick - last.tick));
  if (!(share < 1.0)) return;
  next.behind = true;
  next.torque.torque = before + share * change;
}

PlatformReference ModeSelector::select(const ReactionState& state, const PlatformReference& nominal_motion,
                                       const PlatformReference& reaction_motion) const {
  switch (law_of(state.mode, false)) {
    case Law::nominal:
      return nominal_motion;
    case Law::reacting:
      return reaction_motion;
    case Law::yielding:
    case Law::stopping:
    case Law::zero_gravity:
      break;
  }
  return {};
}

}  // namespace flinch
