#pragma once

#include <memory>

#include "experiments/simulated/closed_loop.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/diagram.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"

namespace flinch::test {

/// The closed loop of a scenario, to be looked at tick by tick without a recording.
struct ScenarioLoop {
  explicit ScenarioLoop(const SimulatedScenario& scenario)
      : builder("experiment", scenario.control_period),
        parts(add_closed_loop(builder, scenario, scenario.control)),
        station(parts.station),
        control(parts.control),
        diagram(closed()),
        simulator(*diagram, std::make_unique<SundialsIntegrator>()),
        context(diagram->make_context()) {}

  ScenarioLoop(const ScenarioLoop&) = delete;  // its references lead into itself
  ScenarioLoop& operator=(const ScenarioLoop&) = delete;

  void tick() { simulator.step(context); }

  DiagramBuilder builder;
  StationAndControl parts;
  const SimulatedStation& station;
  const ContactControl& control;
  InputPort<OperatorCommand> buttons;  ///< none is pressed until somebody does
  std::unique_ptr<const Diagram> diagram;
  Simulator simulator;
  Context context;

 private:
  std::unique_ptr<const Diagram> closed() {
    buttons = builder.export_input("operator", control.operator_command);
    return builder.build();
  }
};

}  // namespace flinch::test
