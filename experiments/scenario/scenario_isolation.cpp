#include "experiments/scenario/scenario_isolation.h"

#include "diagrams/isolation_settings.h"
#include "systems/config/config_reader.h"

namespace flinch {

void read_isolation(ConfigReader isolation, IsolationSettings& settings) {
  isolation.number("observer_gain", unit::per_s, settings.observer_gain, positive);
  isolation.number("force_deviation", unit::N, settings.uncertainty.force, positive);
  isolation.number("moment_deviation", unit::Nm, settings.uncertainty.moment, positive);
  isolation.number("force_scale", unit::N, settings.hypotheses.force_scale, positive);
  isolation.number("object_speed", unit::m_per_s, settings.hypotheses.object_speed, positive);
  isolation.number("friction", unit::none, settings.hypotheses.friction, not_negative);
  isolation.number("accept", unit::none, settings.model_classifier.accept, fraction);
  settings.decision_tree.accept = settings.model_classifier.accept;
  ConfigReader right = isolation.section("decision_tree");
  right.number("right_of_platform", unit::none, settings.decision_tree.right_of_platform, fraction);
  right.number("right_of_link1", unit::none, settings.decision_tree.right_of_link1, fraction);
  right.number("right_of_link2", unit::none, settings.decision_tree.right_of_link2, fraction);
  right.number("right_of_clamping", unit::none, settings.decision_tree.right_of_clamping, fraction);
  isolation.number("largest_residual", unit::none, settings.model_classifier.largest_residual, positive);
  isolation.duration("window", settings.model_classifier.window, not_negative);
  isolation.number("leaning", unit::none, settings.closed_form.leaning, not_negative);
  settings.particle_filter.leaning = settings.closed_form.leaning;
  isolation.integer("particles", settings.particle_filter.particles, 1, max_particles);
}

}  // namespace flinch
