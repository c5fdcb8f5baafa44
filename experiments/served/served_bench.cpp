#include "experiments/served/served_bench.h"

#include "experiments/simulated/simulated_scenario.h"
#include "plant/simulated_station.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

ServedBench build_served_bench(const SimulatedScenario& scenario, Time longest_silence) {
  DiagramBuilder builder("bench", scenario.control_period);
  SimulatedStationSettings settings = scenario.station;
  settings.drives.longest_silence = longest_silence;
  PoweredStation station = add_powered_station(builder, add_simulated_station(builder, settings));
  station.torque_command = builder.export_input("torque_command", station.torque_command);
  station.brake = builder.export_input("brake", station.brake);
  station.wish = builder.export_input("wish", station.wish);
  return {builder.build(), station};
}

WaitingBench build_waiting_bench(const SimulatedScenario& scenario) {
  DiagramBuilder builder("bench", scenario.control_period);
  // The bus knows no more of it. NOLINTNEXTLINE(cppcoreguidelines-slicing)
  Station station = add_simulated_station(builder, scenario.station);
  station.torque_command = builder.export_input("torque_command", station.torque_command);
  station.brake = builder.export_input("brake", station.brake);
  return {builder.build(), station};
}

}  // namespace flinch
