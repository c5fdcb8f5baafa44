#include "systems/laws/scripted_operator.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using After = OperatorEvent::After;

/// What the robot does, as the operator sees it.
struct Seen {
  ReactionMode mode;
  GatePhase phase;
  bool finished;  ///< the reference rests
  bool at_rest;   ///< the drives do
};

bool is_so(After what, const Seen& seen) {
  const bool given_way = seen.mode == ReactionMode::hold || seen.mode == ReactionMode::zero_g;
  switch (what) {
    case After::time:
      return true;
    case After::ended:
      return seen.at_rest && (given_way || seen.phase == GatePhase::closed);
    case After::recovering:
      return seen.mode == ReactionMode::recover;
    case After::arrived:
      return seen.mode == ReactionMode::nominal && seen.finished;
  }
  return false;
}

/// Hands a target on, under a number of its own.
void give(const TargetCommand& target, ScriptedOperator::Course& course) {
  const std::uint32_t number = course.target.number + 1;
  course.target = target;
  course.target.number = number;
}

/// Whether there is no need for this event.
bool is_left_out(const OperatorScript& script, std::size_t event, const Seen& seen) {
  return event < script.events.size() && script.events[event].after == After::recovering &&
         seen.mode == ReactionMode::nominal;
}

/// Whether it is `so` for as long as `wait`.
bool lasts(bool so, Time now, Time wait, ScriptedOperator::Since& since) {
  if (!so) since = {};
  if (!so) return false;
  if (!std::exchange(since.is_so, true)) since.begin = now;
  return now - since.begin >= wait;
}

/// The event that is due, where one is.
std::optional<std::size_t> due(const OperatorScript& script, std::size_t after_end, Time now,
                               const Seen& seen, ScriptedOperator::Course& course) {
  const auto& events = script.events;
  const bool began = course.next > after_end;
  if (began && lasts(is_so(After::ended, seen), now, events[after_end].wait, course.ended)) return after_end;
  for (; is_left_out(script, course.next, seen); ++course.next) course.awaited = {};
  if (course.next >= events.size()) return std::nullopt;
  const OperatorEvent& event = events[course.next];
  const bool is_due = event.after == After::time
                          ? now >= event.wait
                          : lasts(is_so(event.after, seen), now, event.wait, course.awaited);
  return is_due ? std::optional(course.next) : std::nullopt;
}

void act(const OperatorEvent& event, ScriptedOperator::Course& course) {
  course.buttons.start |= event.buttons.start;
  course.buttons.reset |= event.buttons.reset;
  course.buttons.stop |= event.buttons.stop;
  if (event.target.kind != TargetCommand::Kind::none) give(event.target, course);
}

/// Does what is due, but leaves a tick between two events, so that a button goes down anew.
void follow(const OperatorScript& script, std::size_t after_end, Time now, const Seen& seen,
            ScriptedOperator::Course& course) {
  if (std::exchange(course.has_acted, false)) return;
  const std::optional<std::size_t> event = due(script, after_end, now, seen, course);
  if (!event) return;
  act(script.events[*event], course);
  course.next = *event + 1;
  course.awaited = course.ended = {};
  course.has_acted = true;
}

}  // namespace

ScriptedOperator::ScriptedOperator(OperatorScript script)
    : script_(std::move(script)),
      after_end_(static_cast<std::size_t>(
          std::find_if(script_.events.begin(), script_.events.end(),
                       [](const OperatorEvent& event) { return event.after == After::ended; }) -
          script_.events.begin())) {
  if (!(script_.rest_speed > 0)) throw SetupError("scripted operator: rest_speed must be positive");
}

void ScriptedOperator::advance(Time now, const Course& last, ReactionMode mode, GatePhase phase,
                               bool finished, const JointMotion& motion, const OperatorCommand& pressed,
                               const TargetCommand& wanted, Course& course) const {
  course = last;
  course.buttons = pressed;
  course.is_silent |= pressed.stop;
  course.panel_target = wanted.number;
  const Seen seen{mode, phase, finished, motion.rests(script_.rest_speed)};
  if (!course.is_silent) follow(script_, after_end_, now, seen, course);
  if (wanted.number != last.panel_target) give(wanted, course);
}

}  // namespace flinch
