#include "experiments/scenario/scenario_operator.h"

#include <optional>
#include <string>
#include <string_view>

#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/scenario_pose.h"
#include "systems/config/config_reader.h"
#include "systems/config/parsed.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using After = OperatorEvent::After;

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
  target.pose = read_pose(entry.section("pose"), robot);
  if (!robot.inverse_kinematics(target.pose, robot.home_working_mode()).reachable)
    entry.problem("pose", "is out of the reach of the legs; choose a nearer pose");
}

/// When it is done. The entry that stands before it, where there is one.
void read_occasion(ConfigReader& entry, const OperatorEvent* before, Time duration, OperatorEvent& event) {
  if (entry.has("after")) {
    event.after = After::ended;
    entry.choice("after", event.after,
                 {{"ended", After::ended}, {"recovering", After::recovering}, {"arrived", After::arrived}});
    entry.duration("wait", event.wait, not_negative);
    return;
  }
  entry.required().duration("at", event.wait, positive);
  if (event.wait >= duration) {
    entry.problem("at", "is " + exact_text(to_seconds(event.wait)) + " s; the run ends after " +
                            exact_text(to_seconds(duration)) + " s");
  }
  if (before == nullptr) return;
  if (before->after != After::time) {
    entry.problem("at", "stands behind an entry with 'after', of which no time is known; put it before");
  } else if (event.wait <= before->wait) {
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
    read_occasion(entry, script.events.empty() ? nullptr : &script.events.back(), duration, event);
    const std::string_view what = entry.one_of({"press", "pose", "step"});
    if (what == "press") read_button(entry, has_motion, event.buttons);
    if (what == "pose" || what == "step") read_target(entry, robot, what == "pose", event.target);
    script.events.push_back(event);
  }
  return script;
}

}  // namespace flinch
