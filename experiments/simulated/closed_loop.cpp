#include "experiments/simulated/closed_loop.h"

#include "experiments/simulated/contact_teller.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

StationAndControl add_closed_loop(DiagramBuilder& builder, const SimulatedScenario& scenario,
                                  ContactControlSettings settings) {
  const SimulatedStation station = add_simulated_station(builder, scenario.station);
  settings.contact_is_told = !scenario.station.told_contact.empty();
  const ContactControl control = add_contact_control(builder, scenario.robot.robot, settings);
  connect(builder, station, control);
  builder.connect(builder.add<Constant<TickTiming>>("tick_timing", TickTiming()).value, control.tick_timing);
  if (settings.contact_is_told) {
    auto& teller =
        builder.add<ContactTeller>("contact_teller", scenario.robot.robot, scenario.station.told_contact);
    builder.connect(station.contact_truth, teller.contact);
    builder.connect(station.platform_truth, teller.platform);
    builder.connect(teller.classification, control.told_classification);
    builder.connect(teller.location, control.told_location);
    builder.export_output("told_classification", teller.classification);
    builder.export_output("told_location", teller.location);
  }
  return {station, control};
}

}  // namespace flinch
