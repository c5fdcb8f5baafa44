#include "experiments/simulated/closed_loop.h"

#include <string>

#include "experiments/simulated/contact_teller.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {
namespace {

/// The class that the experiment brings about: the one that the control is told, or that is expected.
std::string made_for(const SimulatedScenario& scenario) {
  const std::string& told = scenario.station.told_contact;
  return told == "truth" ? scenario.expected.contact.value_or("") : told;
}

}  // namespace

StationAndControl add_closed_loop(DiagramBuilder& builder, const SimulatedScenario& scenario,
                                  ContactControlSettings settings) {
  const SimulatedStation station = add_simulated_station(builder, scenario.station);
  settings.contact_is_told = !scenario.station.told_contact.empty();
  const ContactControl control = add_contact_control(builder, scenario.robot.robot, settings);
  connect(builder, station, control);
  builder.connect(builder.add<Constant<TickTiming>>("tick_timing", TickTiming()).value, control.tick_timing);
  if (settings.contact_is_told) {
    auto& teller = builder.add<ContactTeller>("contact_teller", scenario.robot.robot, made_for(scenario));
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
