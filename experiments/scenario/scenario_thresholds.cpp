#include "experiments/scenario/scenario_thresholds.h"

#include <algorithm>
#include <set>

#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/scenario_fused_detector.h"
#include "systems/config/config_reader.h"
#include "systems/config/parsed.h"
#include "systems/foundation/nearest_name.h"

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

/// `estimators`: all that a file may name, whether they run or not.
void read_contact_detector(ConfigReader detector, const std::vector<std::string>& estimators,
                           ContactControlSettings& settings) {
  detector.number("reaction_force", unit::N, settings.contact_detector.reaction.force, positive);
  detector.number("reaction_moment", unit::Nm, settings.contact_detector.reaction.moment, positive);
  detector.number("hard_force", unit::N, settings.contact_detector.hard.force, positive);
  detector.number("hard_moment", unit::Nm, settings.contact_detector.hard.moment, positive);
  const auto& [reaction, hard, period] = settings.contact_detector;
  check_hard(detector, "force", hard.force, reaction.force, "N");
  check_hard(detector, "moment", hard.moment, reaction.moment, "Nm");
  std::set<std::string> named;
  for (ConfigReader& own : detector.sections("by_estimator")) {
    std::string estimator;
    own.required().text("estimator", estimator);
    OwnThreshold& threshold = settings.reaction_thresholds[estimator];
    own.number("reaction_force", unit::N, threshold.force, positive);
    own.number("reaction_moment", unit::Nm, threshold.moment, positive);
    if (std::find(estimators.begin(), estimators.end(), estimator) == estimators.end()) {
      own.problem("estimator",
                  "is '" + estimator + "', which is no estimator" + did_you_mean(estimator, estimators));
    } else if (!named.insert(estimator).second) {
      own.problem("estimator", "is '" + estimator + "', as that of an entry before it");
    }
  }
}

}  // namespace

void read_thresholds(ConfigReader control, DriveKind drives, const std::vector<std::string>& estimators,
                     ContactControlSettings& settings) {
  read_contact_detector(control.section("contact_detector"), estimators, settings);
  read_fused_detector(control.section("fused_detector"), drives, estimators, settings.fused_detector);
}

}  // namespace flinch
