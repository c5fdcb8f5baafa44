#include "experiments/scenario/scenario_operator.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/scenario_pose.h"
#include "systems/config/config_reader.h"
#include "systems/config/parsed.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using After = OperatorEvent::After;
using Events = std::vector<OperatorEvent>;

enum class Button { start, reset, stop };

void read_button(ConfigReader& entry, bool has_motion, OperatorCommand& buttons) {
  Button button = Button::reset;
  entry.choice("press", button, {{"start", Button::start}, {"reset", Button::reset}, {"stop", Button::stop}});
  buttons = {
      .start = button == Button::start, .reset = button == Button::reset, .stop = button == Button::stop};
  if (buttons.start && !has_motion) {
    entry.problem("press",
                  "is 'start', but there is no nominal motion; 'motion' says which, or a 'pose' "
                  "leads elsewhere");
  }
}

void read_target(ConfigReader& entry, const ParallelRobot& robot, bool is_pose, TargetCommand& target) {
  if (!is_pose) {
    target.kind = TargetCommand::Kind::step;
    target.step = read_step(entry.section("step"), robot.space());
    return;
  }
  target.kind = TargetCommand::Kind::pose;
  target.pose = read_pose_in_reach(entry, "pose", robot);
}

/// Refuses what would only come when the run is over.
void check_in_run(ConfigReader& entry, std::string_view key, Time time, Time duration) {
  if (time < duration) return;
  entry.problem(key, "is " + exact_text(to_seconds(time)) + " s; the run ends after " +
                         exact_text(to_seconds(duration)) + " s");
}

void read_what_it_follows(ConfigReader& entry, const Events& before, Time duration, OperatorEvent& event) {
  event.after = After::ended;
  entry.choice("after", event.after,
               {{"ended", After::ended}, {"recovering", After::recovering}, {"arrived", After::arrived}});
  entry.duration("wait", event.wait, not_negative);
  check_in_run(entry, "wait", event.wait, duration);
  const bool is_reset =
      std::any_of(before.begin(), before.end(), [](const OperatorEvent& of) { return of.buttons.reset; });
  if (event.after == After::recovering && !is_reset)
    entry.problem("after", "is 'recovering', but no entry before it presses 'reset', which begins that");
}

/// When it is done. The entries that stand before it.
void read_occasion(ConfigReader& entry, const Events& before, Time duration, OperatorEvent& event) {
  if (entry.has("after")) return read_what_it_follows(entry, before, duration, event);
  entry.required().duration("at", event.wait, positive);
  check_in_run(entry, "at", event.wait, duration);
  if (before.empty()) return;
  if (before.back().after != After::time) {
    entry.problem("at", "stands behind an entry with 'after', of which no time is known; put it before");
  } else if (event.wait <= before.back().wait) {
    entry.problem("at", "is not after that of the entry before it");
  }
}

}  // namespace

OperatorScript read_operator(ConfigReader& scenario, const ParallelRobot& robot,
                             const ContactControlSettings& control, Time duration) {
  OperatorScript script{.events = {}, .rest_speed = control.sequence.rest_speed};
  const bool has_motion = control.trajectory.path.has_value() || !scenario.good();
  for (ConfigReader& entry : scenario.sections("operator")) {
    OperatorEvent event;
    read_occasion(entry, script.events, duration, event);
    const std::string_view what = entry.one_of({"press", "pose", "step"});
    if (what == "press") read_button(entry, has_motion, event.buttons);
    if (what == "pose" || what == "step") read_target(entry, robot, what == "pose", event.target);
    script.events.push_back(event);
  }
  return script;
}

}  // namespace flinch
