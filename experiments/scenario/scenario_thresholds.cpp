#include "experiments/scenario/scenario_thresholds.h"

#include <algorithm>
#include <optional>
#include <set>

#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/scenario_fused_detector.h"
#include "systems/config/config_reader.h"
#include "systems/config/parsed.h"
#include "systems/foundation/nearest_name.h"
#include "systems/robot/configuration_space.h"

namespace flinch {
namespace {

/// A threshold of a hard contact against that of a reaction. `unit`: as a person writes it.
void check_hard(ConfigReader& detector, const std::string& quantity, double hard, double reaction,
                const std::string& unit) {
  if (hard >= reaction) return;
  detector.problem("hard_" + quantity, "is " + exact_text(hard) + " " + unit +
                                           "; it must be at least reaction_" + quantity + ", which is " +
                                           exact_text(reaction) + " " + unit);
}

/// One threshold for all components, or a list with one for each of `components`.
void read_bounds(ConfigReader& reader, const std::string& name, const Unit& unit,
                 std::optional<std::size_t> components, std::optional<ComponentBounds>& bounds) {
  std::vector<double> values = bounds ? bounds->values() : std::vector<double>();
  reader.one_or_numbers(name, unit, values, components, positive);
  if (!values.empty()) bounds = ComponentBounds(values);
}

void read_bounds(ConfigReader& reader, const std::string& name, const Unit& unit,
                 std::optional<std::size_t> components, ComponentBounds& bounds) {
  std::optional<ComponentBounds> read = bounds;
  read_bounds(reader, name, unit, components, read);
  bounds = *read;
}

std::optional<std::size_t> count(const ConfigurationSpace* space, int (ConfigurationSpace::*of)() const) {
  return space == nullptr ? std::nullopt : std::optional(static_cast<std::size_t>((space->*of)()));
}

/// `estimators`: all that a file may name, whether they run or not.
void read_contact_detector(ConfigReader detector, const ConfigurationSpace* space,
                           const std::vector<std::string>& estimators, ContactControlSettings& settings) {
  const auto forces = count(space, &ConfigurationSpace::translations),
             moments = count(space, &ConfigurationSpace::rotations);
  read_bounds(detector, "reaction_force", unit::N, forces, settings.contact_detector.reaction.force);
  read_bounds(detector, "reaction_moment", unit::Nm, moments, settings.contact_detector.reaction.moment);
  detector.number("hard_force", unit::N, settings.contact_detector.hard.force, positive);
  detector.number("hard_moment", unit::Nm, settings.contact_detector.hard.moment, positive);
  const auto& [reaction, hard, period] = settings.contact_detector;
  check_hard(detector, "force", hard.force, reaction.force.largest(), "N");
  check_hard(detector, "moment", hard.moment, reaction.moment.largest(), "Nm");
  std::set<std::string> named;
  for (ConfigReader& own : detector.sections("by_estimator")) {
    std::string estimator;
    own.required().text("estimator", estimator);
    OwnThreshold& threshold = settings.reaction_thresholds[estimator];
    read_bounds(own, "reaction_force", unit::N, forces, threshold.force);
    read_bounds(own, "reaction_moment", unit::Nm, moments, threshold.moment);
    if (std::find(estimators.begin(), estimators.end(), estimator) == estimators.end()) {
      own.problem("estimator",
                  "is '" + estimator + "', which is no estimator" + did_you_mean(estimator, estimators));
    } else if (!named.insert(estimator).second) {
      own.problem("estimator", "is '" + estimator + "', as that of an entry before it");
    }
  }
}

}  // namespace

void read_thresholds(ConfigReader control, DriveKind drives, const ConfigurationSpace* space,
                     const std::vector<std::string>& estimators, ContactControlSettings& settings) {
  read_contact_detector(control.section("contact_detector"), space, estimators, settings);
  read_fused_detector(control.section("fused_detector"), drives, estimators, settings.fused_detector);
}

}  // namespace flinch
