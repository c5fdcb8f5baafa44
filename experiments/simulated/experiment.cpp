#include "experiments/simulated/experiment.h"

#include "diagrams/contact_control.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/quantity_units.h"

namespace flinch {

Experiment build_experiment(const SimulatedScenario& scenario) {
  DiagramBuilder builder("experiment", 1ms);
  const SimulatedStation station = add_simulated_station(builder, scenario.station);
  const ContactControl control = add_contact_control(builder, scenario.robot.robot, scenario.control);
  connect(builder, station, control);
  const auto operator_command = builder.export_input("operator", control.operator_command);
  const auto target = builder.export_input("target", control.target);
  builder.connect(builder.add<Constant<TickTiming>>("tick_timing", TickTiming()).value, control.tick_timing);
  builder.export_output("truth", station.plant_truth);
  builder.export_output("contact", station.contact_truth);
  export_readings(builder, station);
  export_control(builder, control);
  return {builder.build(), operator_command, target};
}

Recording run_experiment(const SimulatedScenario& scenario,
                         const std::map<std::string, std::string>& provenance,
                         const std::function<void(double share)>& progress) {
  const Experiment experiment = build_experiment(scenario);
  const Diagram& diagram = *experiment.diagram;
  const auto ticks = static_cast<std::size_t>(scenario.duration / diagram.tick());
  Recorder recorder(diagram, recorded_paths(diagram), ticks, quantity_units(*scenario.robot.robot));
  Simulator simulator(diagram, std::make_unique<SundialsIntegrator>());
  simulator.record(recorder);

  Context context = diagram.make_context();
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    if (progress && tick % 50 == 0) progress(static_cast<double>(tick) / static_cast<double>(ticks));
    simulator.step(context);
  }
  auto attributes = recorded_attributes(scenario, provenance);
  attributes["simulation.inaccurate_steps"] = std::to_string(simulator.inaccurate_steps());
  return recorder.recording(std::move(attributes));
}

}  // namespace flinch
