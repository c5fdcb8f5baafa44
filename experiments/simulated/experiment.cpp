#include "experiments/simulated/experiment.h"

#include <algorithm>

#include "diagrams/operator_ports.h"
#include "diagrams/requested_fault.h"
#include "experiments/live/spectator.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/recorded/robot_as_drawn.h"
#include "experiments/simulated/closed_loop.h"
#include "experiments/simulated/exported_truth.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/run_monitor.h"
#include "experiments/verdict/verdict.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/recorder.h"
#include "systems/framework/recording_stream.h"
#include "systems/framework/simulator.h"
#include "systems/robot/quantity_units.h"

namespace flinch {

namespace {

template <class S>
void keep_followed(Stages<S>& stages) {
  const std::string followed = followed_name(stages);
  std::erase_if(stages.all, [&](const S& stage) { return stage.name != followed; });
}

/// Without the stages that have no effect and of which no verdict tells.
ContactControlSettings judged_control(ContactControlSettings settings) {
  keep_followed(settings.stages.classifiers);
  keep_followed(settings.stages.locators);
  keep_followed(settings.stages.nominal_laws);
  keep_followed(settings.stages.reaction_laws);
  return settings;
}

Experiment build(const SimulatedScenario& scenario, const ContactControlSettings& settings) {
  require_possible(scenario.station.faults, {.end = scenario.duration});
  DiagramBuilder builder("experiment", scenario.control_period);
  const auto [station, control] = add_closed_loop(builder, scenario, settings);
  const OperatorPorts panel = add_operator(builder, control, scenario.operator_script);
  export_truth(builder, scenario, station);
  export_readings(builder, station);
  export_control(builder, control);
  return {builder.build(), panel.buttons, panel.target};
}

constexpr std::size_t samples_at_once = 64;  // of a run that is judged while it goes on

std::size_t ticks_of(const SimulatedScenario& scenario, const Diagram& diagram) {
  return static_cast<std::size_t>(scenario.duration / diagram.tick());
}

/// What is known of a run before it begins.
std::map<std::string, std::string> attributes_of(const SimulatedScenario& scenario,
                                                 const std::map<std::string, std::string>& provenance) {
  auto attributes = recorded_attributes(scenario, provenance);
  note_robot(perturbed_robot_values(scenario.perturbed_robot, *scenario.robot.robot), attributes);
  std::string faults;
  for (const RequestedFault& fault : scenario.station.faults) {
    faults += (faults.empty() ? "" : " ") + text_of(fault);
  }
  if (!faults.empty()) attributes.emplace("faults", std::move(faults));
  return attributes;
}

/// Runs the whole scenario; `before_tick` is called between ticks. What is known of the run only then.
std::map<std::string, std::string> simulate(const SimulatedScenario& scenario, const Diagram& diagram,
                                            const std::vector<Recorder*>& recorders,
                                            const std::function<void()>& before_tick,
                                            const std::function<void(double share)>& progress) {
  Simulator simulator(diagram, std::make_unique<SundialsIntegrator>());
  for (Recorder* const recorder : recorders) simulator.record(*recorder);
  Context context = diagram.make_context();
  const std::size_t ticks = ticks_of(scenario, diagram);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    if (progress && tick % 50 == 0) progress(static_cast<double>(tick) / static_cast<double>(ticks));
    if (before_tick) before_tick();
    simulator.step(context);
  }
  return {{"simulation.inaccurate_steps", std::to_string(simulator.inaccurate_steps())}};
}

}  // namespace

Experiment build_experiment(const SimulatedScenario& scenario) { return build(scenario, scenario.control); }

Recording run_experiment(const SimulatedScenario& scenario,
                         const std::map<std::string, std::string>& provenance,
                         const std::function<void(double share)>& progress) {
  const Experiment experiment = build_experiment(scenario);
  const Diagram& diagram = *experiment.diagram;
  Recorder recorder(diagram, recorded_paths(diagram), ticks_of(scenario, diagram),
                    quantity_units(*scenario.robot.robot));
  auto attributes = simulate(scenario, diagram, {&recorder}, {}, progress);
  attributes.merge(attributes_of(scenario, provenance));
  return recorder.recording(std::move(attributes));
}

Verdict judge_experiment(const SimulatedScenario& scenario) {
  const Experiment experiment = build(scenario, judged_control(scenario.control));
  const Diagram& diagram = *experiment.diagram;
  std::vector<std::string> paths = recorded_paths(diagram);
  std::erase_if(paths, [](const std::string& path) { return !is_judged(path); });
  Recorder recorder(diagram, paths, samples_at_once, quantity_units(*scenario.robot.robot));
  Recording latest = recorder.description(recorded_attributes(scenario, {}));
  const RecordedRun run(latest, scenario.robot.robot->space());
  RunMonitor watch(run, scenario.force_limits);
  const auto look = [&] {
    latest.time_ns.clear();
    for (Signal& signal : latest.signals) signal.rows.clear();
    latest.append(recorder.front());
    recorder.clear();
    for (std::size_t k = 0; k < run.size(); ++k) watch.see(run[k]);
  };
  const auto look_when_full = [&] {
    if (recorder.samples() == samples_at_once) look();
  };
  simulate(scenario, diagram, {&recorder}, look_when_full, {});
  look();
  return judge(watch, scenario.expected);
}

Recording run_for_signals(const SimulatedScenario& scenario, const std::vector<std::string>& names) {
  const Experiment experiment = build_experiment(scenario);
  const Diagram& diagram = *experiment.diagram;
  std::vector<std::string> paths = recorded_paths(diagram);
  std::erase_if(paths, [&names](const std::string& path) {
    return std::find(names.begin(), names.end(), path) == names.end();
  });
  Recorder recorder(diagram, paths, ticks_of(scenario, diagram), quantity_units(*scenario.robot.robot));
  simulate(scenario, diagram, {&recorder}, {}, {});
  return recorder.recording();
}

Recording record_experiment(const SimulatedScenario& scenario, const std::filesystem::path& file,
                            const std::map<std::string, std::string>& provenance,
                            const std::function<void(double share)>& progress, Spectator* spectator) {
  const Experiment experiment = build_experiment(scenario);
  const Diagram& diagram = *experiment.diagram;
  const UnitTable units = quantity_units(*scenario.robot.robot);
  Recorder recorder(diagram, recorded_paths(diagram), RecordingStream::ring, units);
  const auto attributes = attributes_of(scenario, provenance);
  RecordingStream stream(recorder, file, attributes);
  std::vector<Recorder*> recorders{&recorder};
  if (spectator != nullptr) recorders.push_back(&spectator->begin(diagram, units, attributes));
  Time now{};
  const auto before_tick = [&] {
    stream.wait_for_room();
    if (spectator != nullptr) spectator->before_tick(now);
    now += diagram.tick();
  };
  stream.finish(simulate(scenario, diagram, recorders, before_tick, progress));
  return open_recording(file);
}

}  // namespace flinch
