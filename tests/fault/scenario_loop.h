#pragma once

#include <memory>

#include "diagrams/contact_control.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"

namespace flinch::test {

/// The closed loop of a scenario, to be looked at tick by tick without a recording.
struct ScenarioLoop {
  explicit ScenarioLoop(const SimulatedScenario& scenario)
      : station(add_simulated_station(builder, scenario.station)),
        control(add_contact_control(builder, scenario.robot.robot, scenario.control)),
        diagram(closed()),
        simulator(*diagram, std::make_unique<SundialsIntegrator>()),
        context(diagram->make_context()) {}

  void tick() { simulator.step(context); }

  DiagramBuilder builder{"experiment", 1ms};
  SimulatedStation station;
  ContactControl control;
  InputPort<OperatorCommand> buttons;  ///< none is pressed until somebody does
  std::unique_ptr<const Diagram> diagram;
  Simulator simulator;
  Context context;

 private:
  std::unique_ptr<const Diagram> closed() {
    connect(builder, station, control);
    buttons = builder.export_input("operator", control.operator_command);
    const auto& timing = builder.add<Constant<TickTiming>>("tick_timing", TickTiming());
    builder.connect(timing.value, control.tick_timing);
    return builder.build();
  }
};

}  // namespace flinch::test
