#include "diagrams/contact_control_settings.h"

#include <algorithm>

namespace flinch {

ContactDetectorSettings ContactControlSettings::detector_of(const std::string& estimator) const {
  ContactDetectorSettings settings = contact_detector;
  const auto own = reaction_thresholds.find(estimator);
  if (own == reaction_thresholds.end()) return settings;
  settings.reaction.force = own->second.force.value_or(settings.reaction.force);
  settings.reaction.moment = own->second.moment.value_or(settings.reaction.moment);
  settings.hard.force = std::max(settings.hard.force, settings.reaction.force.largest());
  settings.hard.moment = std::max(settings.hard.moment, settings.reaction.moment.largest());
  return settings;
}

}  // namespace flinch
