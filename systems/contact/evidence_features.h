#pragma once

#include <string>
#include <vector>

#include "systems/contact/feature_extraction.h"
#include "systems/contact/neural_network.h"
#include "systems/signals/contact_classes.h"

namespace flinch {

/// What a network is told of each class before it says how likely that is: a column for each class, so that
/// one network serves all legs of all robots. Of the evidence of the model, and of the classes that are
/// easily taken for it; nothing of pose, joint angles or rates, by which a network would remember where it
/// was trained. `force`: size of the estimated force [N]. Numbers are bounded, whatever the evidence.
void evidence_features(const ContactClasses& classes, const ContactEvidence& evidence, double force,
                       NeuralNetwork::Values& columns) noexcept;

inline constexpr int evidence_feature_count = 32;

/// What the rows of `evidence_features` are.
std::vector<FeatureName> evidence_feature_names();

}  // namespace flinch
