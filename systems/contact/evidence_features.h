#pragma once

#include <string>
#include <vector>

#include "systems/contact/feature_extraction.h"
#include "systems/contact/neural_network.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/signals/contact_classes.h"

namespace flinch {

/// How the evidence of the changes is weighed, for which few points do; that of the wrench by default.
inline TouchHypothesesSettings hypotheses_of_change() {
  TouchHypothesesSettings settings;
  settings.points_along = 12;
  settings.points_around = 24;
  return settings;
}

/// The evidence of the model for an estimated wrench and for how it has grown (`WrenchGrowth`).
struct GrowthEvidence {
  const ContactEvidence& whole;          ///< of the wrench itself
  const ContactEvidence& change;         ///< of its change during the last step
  const ContactEvidence& change_before;  ///< and during the one before
  double force = 0.0;                    ///< size of the estimated force [N]
};

/// What a network is told of each class before it says how likely that is: a column for each class, so that
/// one network serves all legs of all robots. Of the evidence of the model, and of the classes that are
/// easily taken for it; nothing of pose, joint angles or rates, by which a network would remember where it
/// was trained. Numbers are bounded, whatever the evidence; zeros where some of it is not valid.
void evidence_features(const ContactClasses& classes, const GrowthEvidence& seen,
                       NeuralNetwork::Values& columns) noexcept;

inline constexpr int evidence_feature_count = 86;

/// What the rows of `evidence_features` are.
std::vector<FeatureName> evidence_feature_names();

}  // namespace flinch
