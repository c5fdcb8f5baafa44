#pragma once

#include <string>
#include <vector>

#include "systems/contact/feature_extraction.h"
#include "systems/contact/leg_history.h"
#include "systems/contact/neural_network.h"
#include "systems/signals/contact_classes.h"

namespace flinch {

/// What is known of a contact: the evidence of the model, and how it has come about.
struct SeenContact {
  const ContactEvidence& whole;   ///< of the estimated wrench
  const ContactEvidence& growth;  ///< of what of it has come since the first moment of the course
  const LegCourses& courses;      ///< in the coordinates of each leg
  double force = 0.0;             ///< size of the estimated force [N]
};

/// What a network is told of each class before it says how likely that is: a column for each class, so that
/// one network serves all legs of all robots. Of the evidence of the model, and of the classes that are
/// easily taken for it, and of the course as the leg of the class has felt it. Numbers are bounded, whatever
/// the evidence; zeros where some of it is not valid.
void evidence_features(const ContactClasses& classes, const SeenContact& seen,
                       NeuralNetwork::Values& columns) noexcept;

inline constexpr int evidence_feature_count = 60 + 5 * static_cast<int>(window_ages.size());

/// What the rows of `evidence_features` are.
std::vector<FeatureName> evidence_feature_names();

}  // namespace flinch
