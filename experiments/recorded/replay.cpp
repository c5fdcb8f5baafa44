#include "experiments/recorded/replay.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "diagrams/contact_control.h"
#include "diagrams/recorded_station.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/recorded/robot_as_drawn.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/player.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/quantity_units.h"

namespace flinch {
namespace {

const Signal* find(const Recording& recording, const std::string& path) {
  const auto found = std::find_if(recording.signals.begin(), recording.signals.end(),
                                  [&path](const Signal& signal) { return signal.path == path; });
  return found == recording.signals.end() ? nullptr : &*found;
}

/// Scenario, robot and calibrations, as a recording keeps them.
std::map<std::string, std::string> texts_in(std::map<std::string, std::string> attributes) {
  std::erase_if(attributes, [](const auto& attribute) {
    const std::string& name = attribute.first;
    const bool is_one = name == "scenario.text" || name == "robot.text" || name.starts_with("calibration.");
    return !is_one || !name.ends_with(".text");
  });
  return attributes;
}

/// The control that runs on the readings. What another than the recorded one commands has never reached the
/// drives whose currents are seen.
ContactControlSettings control_over(const Scenario& scenario, const Recording& recorded) {
  ContactControlSettings settings = scenario.control;
  settings.plausibility.commands_act =
      texts_in(recorded.attributes) == texts_in(recorded_attributes(scenario, {}));
  settings.contact_is_told = find(recorded, "told_classification") != nullptr;
  return settings;
}

/// As it was recorded in real time; in simulated time there was none.
OutputPort<TickTiming> add_timing(DiagramBuilder& builder, const Recording& recorded) {
  if (find(recorded, "tick_timing") == nullptr) {
    return builder.add<Constant<TickTiming>>("tick_timing", TickTiming()).value;
  }
  const auto& timing = builder.add<Player<TickTiming>>("tick_timing", recorded, "tick_timing");
  builder.export_output("tick_timing", timing.played);
  return timing.played;
}

/// What not every recording has: the operator's targets, and what the reaction was told of the contact.
template <class T>
void replay_if_recorded(DiagramBuilder& builder, const Recording& recorded, const std::string& path,
                        InputPort<T> port) {
  if (find(recorded, path) == nullptr) return;
  const auto& player = builder.add<Player<T>>(path, recorded, path);
  builder.connect(player.played, port);
  builder.export_output(path, player.played);
}

bool is_same(const Signal& a, const Signal& b) {
  return a.rows.size() == b.rows.size() &&
         std::memcmp(a.rows.data(), b.rows.data(), a.rows.size() * sizeof(a.rows[0])) == 0;
}

/// Signals of `from` that `recording` has not: the truth, instruments of others, links.
void take_over_the_rest(const Recording& from, Recording& recording) {
  for (const Signal& signal : from.signals) {
    if (find(recording, signal.path) == nullptr) recording.signals.push_back(signal);
  }
}

}  // namespace

std::unique_ptr<Diagram> build_replay(const Scenario& scenario, const Recording& recorded,
                                      const std::vector<RequestedFault>& faults) {
  if (recorded.period != scenario.control_period)
    throw SetupError(fmt::format(
        "{}: its control period is {:g} us, and the recording has one of {:g} us; give the scenario "
        "'control_period_us: {:g}', or replay a recording of its own period",
        scenario.file.string(), 1e6 * to_seconds(scenario.control_period), 1e6 * to_seconds(recorded.period),
        1e6 * to_seconds(recorded.period)));
  DiagramBuilder builder("replay", recorded.period);
  const Station station = add_recorded_station(
      builder, recorded, "", {.all = faults, .tick = recorded.period, .seed = scenario.seed});
  const ContactControl control =
      add_contact_control(builder, scenario.robot.robot, control_over(scenario, recorded));
  const auto& buttons = builder.add<Player<OperatorCommand>>("operator", recorded, "operator");
  connect(builder, station, control);
  builder.connect(buttons.played, control.operator_command);
  builder.connect(add_timing(builder, recorded), control.tick_timing);
  builder.export_output("operator", buttons.played);
  replay_if_recorded(builder, recorded, "target", control.target);
  replay_if_recorded(builder, recorded, "told_classification", control.told_classification);
  replay_if_recorded(builder, recorded, "told_location", control.told_location);
  export_readings(builder, station);
  export_control(builder, control);
  return builder.build();
}

Replay replay(const Scenario& scenario, const Recording& recorded,
              const std::map<std::string, std::string>& provenance,
              const std::function<void(double share)>& progress, const std::vector<RequestedFault>& faults) {
  const auto diagram = build_replay(scenario, recorded, faults);
  Recorder recorder(*diagram, recorded_paths(*diagram), recorded.samples(),
                    quantity_units(*scenario.robot.robot));
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  for (std::size_t tick = 0; tick < recorded.samples(); ++tick) {
    if (progress && tick % 50 == 0) {
      progress(static_cast<double>(tick) / static_cast<double>(recorded.samples()));
    }
    context.set_time(Time(recorded.time_ns[tick]));  // where the clock was followed, periods may be missing
    simulator.step(context);
  }

  auto attributes = recorded_attributes(scenario, provenance);
  note_robot(robot_as_drawn(recorded), attributes);
  Replay result{recorder.recording(std::move(attributes)), {}};
  for (const Signal& signal : result.recording.signals) {
    const Signal* const old = find(recorded, signal.path);
    if (old == nullptr || !is_same(*old, signal)) result.differing.push_back(signal.path);
  }
  take_over_the_rest(recorded, result.recording);
  return result;
}

}  // namespace flinch
