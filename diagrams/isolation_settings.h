#pragma once

#include <cstdint>

#include "systems/contact/contact_locator.h"
#include "systems/contact/decision_tree.h"
#include "systems/contact/feature_extraction.h"
#include "systems/contact/link_particles.h"
#include "systems/contact/model_classifier.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/contact/wrench_uncertainty.h"

namespace flinch {

/// What can be set of how a contact is classified and located.
struct IsolationSettings {
  /// Of the momentum observer that it reads, for every coordinate alike: at the detection tick of one with 20
  /// 1/s that one still estimates a small part of the force [1/s].
  double observer_gain = 100.0;
  WrenchUncertainty uncertainty;  ///< of that observer
  Time same_contact = 100ms;      ///< for so long a contact that has gone may come back as the same

  FeatureSettings features;
  TouchHypothesesSettings hypotheses;
  ModelClassifierSettings model_classifier;
  DecisionTreeSettings decision_tree;
  ContactLocatorSettings closed_form;
  LinkParticleSettings particle_filter;
  std::uint64_t particle_seed = 1;
};

}  // namespace flinch
