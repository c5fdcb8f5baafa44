#include "diagrams/base_force_isolation.h"

#include "diagrams/contact_control_settings.h"
#include "diagrams/low_latency_motion.h"
#include "systems/contact/pair_locator.h"
#include "systems/estimators/base_force_observer.h"
#include "systems/robot/leg_bases.h"
#include "systems/sensors/base_force_filter.h"

namespace flinch {

std::optional<InputPort<BaseForceReading>> add_base_forces(const StageContext& site,
                                                           const ContactPorts& given, OtherStages& shown) {
  const IsolationSettings& settings = site.settings.isolation;
  if (!settings.base_forces) return std::nullopt;
  const auto bases = leg_bases(site.robot, settings.base_forces->first_moment, *site.robot);
  const Sampling sampling = Sampling::each(site.settings.control_period);
  DiagramBuilder& builder = site.builder;
  auto& observer = builder.add<BaseForceObserver>(
      "base_force_observer", bases,
      BaseForceObserverSettings{.gain = settings.observer_gain, .sampling = sampling});
  auto& locator = builder.add<PairLocator>(
      "pair_locator", site.robot, bases, settings.base_forces->pairs, settings.uncertainty,
      whole_periods(settings.base_forces->period, site.settings.control_period));
  builder.connect(given.platform, observer.platform);
  builder.connect(given.kinematics, observer.kinematics);
  builder.connect(given.drive_torque, observer.torque);
  builder.connect(given.contact, locator.phase);
  builder.connect(given.kinematics, locator.kinematics);
  builder.connect(given.isolation_wrench, locator.wrench);
  builder.connect(observer.estimate, locator.bases);
  const auto readings = builder.optional_input<BaseForceReading>("base_forces");
  if (const auto low_pass = torque_low_pass(site.settings)) {
    auto& filter = builder.add<BaseForceFilter>("base_force_filter", *low_pass, sampling);
    builder.connect(readings, filter.measured);
    builder.connect(given.status, filter.status);
    builder.connect(filter.filtered, observer.forces);
  } else {
    builder.connect(readings, observer.forces);
  }
  shown.base_forces.push_back({"base_force", builder.export_output("base_force", observer.estimate)});
  shown.located_contacts.push_back(
      {"located_contacts", builder.export_output("located_contacts", locator.contacts)});
  return readings;
}

}  // namespace flinch
