#include "experiments/served/served_rig.h"

#include "experiments/recorded/recorded_signals.h"
#include "experiments/simulated/exported_truth.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/simulated_station.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/workspace_measures.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {
namespace {

template <class T>
void export_absent(DiagramBuilder& builder, const std::string& name) {
  builder.export_output(name, builder.add<Constant<T>>(name, T()).value);
}

/// For who watches the rig: its readings and truth. What only a controller knows is there and not valid.
void export_rig(DiagramBuilder& builder, const SimulatedScenario& scenario, const SimulatedStation& station,
                const Station& served) {
  export_readings(builder, served);
  export_truth(builder, scenario, station);
  export_absent<ContactDetection>(builder, "detection");
  export_absent<ReactionState>(builder, "reaction");
  export_absent<WrenchEstimate>(builder, "wrench");
  export_absent<PlatformReference>(builder, "reference");
  export_absent<GateStatus>(builder, "gate");
  export_absent<WorkspaceMeasures>(builder, "measures");
}

}  // namespace

ServedRig build_served_rig(const SimulatedScenario& scenario, Time longest_silence, bool is_watched) {
  DiagramBuilder builder("bench", scenario.control_period);
  SimulatedStationSettings settings = scenario.station;
  settings.drives.longest_silence = longest_silence;
  const SimulatedStation simulated = add_simulated_station(builder, settings);
  PoweredStation station = add_powered_station(builder, simulated);
  if (is_watched) export_rig(builder, scenario, simulated, station);
  station.torque_command = builder.export_input("torque_command", station.torque_command);
  station.brake = builder.export_input("brake", station.brake);
  station.wish = builder.export_input("wish", station.wish);
  return {builder.build(), station};
}

WaitingRig build_waiting_rig(const SimulatedScenario& scenario, bool is_watched) {
  DiagramBuilder builder("bench", scenario.control_period);
  const SimulatedStation simulated = add_simulated_station(builder, scenario.station);
  Station station = simulated;  // the bus knows no more of it. NOLINT(cppcoreguidelines-slicing)
  if (is_watched) export_rig(builder, scenario, simulated, station);
  station.torque_command = builder.export_input("torque_command", station.torque_command);
  station.brake = builder.export_input("brake", station.brake);
  return {builder.build(), station};
}

}  // namespace flinch
