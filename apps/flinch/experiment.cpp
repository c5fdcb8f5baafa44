#include "apps/flinch/experiment.h"

#include <vector>

#include "apps/flinch/scenario.h"
#include "diagrams/contact_control.h"
#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"

namespace flinch {
namespace {

/// What a verdict and a report need, by the names that they ask for.
void export_signals(DiagramBuilder& builder, const SimulatedStation& station, const ContactControl& control) {
  builder.export_output("truth", station.plant_truth);
  builder.export_output("contact", station.contact_truth);
  builder.export_output("joints", station.joints);
  builder.export_output("drives", station.drives);
  builder.export_output("imu", station.imu);
  builder.export_output("status", station.status);
  if (station.force_torque) builder.export_output("force_torque", *station.force_torque);

  builder.export_output("motion", control.platform_motion);
  builder.export_output("measures", control.measures);
  builder.export_output("wrench", control.wrench_estimate);
  builder.export_output("detection", control.detection);
  builder.export_output("reaction", control.reaction_state);
  builder.export_output("reference", control.reference);
  builder.export_output("requested_torque", control.requested_torque);
  builder.export_output("torque_command", control.torque_command);
  builder.export_output("brake", control.brake);
  builder.export_output("gate", control.gate);
}

std::vector<std::string> recorded_paths(const Diagram& diagram) {
  std::vector<std::string> paths;
  for (const System::Input& input : diagram.inputs()) paths.push_back(input.name);
  for (const System::Output& output : diagram.outputs()) paths.push_back(output.name);
  return paths;
}

std::map<std::string, std::string> attributes_of(const Scenario& scenario,
                                                 const std::map<std::string, std::string>& provenance) {
  std::map<std::string, std::string> attributes = provenance;
  attributes["flinch.version"] = FLINCH_VERSION;
  attributes["seed"] = std::to_string(scenario.seed);
  attributes["scenario.name"] = scenario.name;
  attributes["scenario.file"] = scenario.file.filename().string();
  attributes["scenario.text"] = scenario.text;
  attributes["robot.file"] = scenario.robot_file.filename().string();
  attributes["robot.text"] = scenario.robot_text;
  return attributes;
}

}  // namespace

Experiment build_experiment(const Scenario& scenario) {
  DiagramBuilder builder("experiment", 1ms);
  const SimulatedStation station = add_simulated_station(builder, scenario.station);
  const ContactControl control = add_contact_control(builder, scenario.robot.robot, scenario.control);
  connect(builder, station, control);
  const auto operator_command = builder.export_input("operator", control.operator_command);
  export_signals(builder, station, control);
  return {builder.build(), operator_command};
}

Recording run_experiment(const Scenario& scenario, const std::map<std::string, std::string>& provenance,
                         const std::function<void(double share)>& progress) {
  const Experiment experiment = build_experiment(scenario);
  const Diagram& diagram = *experiment.diagram;
  const auto ticks = static_cast<std::size_t>(scenario.duration / diagram.tick());
  Recorder recorder(diagram, recorded_paths(diagram), ticks);
  Simulator simulator(diagram, std::make_unique<SundialsIntegrator>());
  simulator.record(recorder);

  Context context = diagram.make_context();
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    if (progress && tick % 50 == 0) progress(static_cast<double>(tick) / static_cast<double>(ticks));
    simulator.step(context);
  }
  auto attributes = attributes_of(scenario, provenance);
  attributes["simulation.inaccurate_steps"] = std::to_string(simulator.inaccurate_steps());
  return recorder.recording(std::move(attributes));
}

}  // namespace flinch
