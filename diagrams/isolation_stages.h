#pragma once

#include <vector>

#include "diagrams/control_stages.h"
#include "systems/contact/learned_classifier.h"
#include "systems/contact/papers_classifier.h"

namespace flinch {

/// Every classifier of flinch, as its settings say, the standard one first.
std::vector<ContactClassifier> classifier_stages();

/// The classifier "learned_classifier", which needs a network and so is none of those.
ContactClassifier learned_classifier_stage(LearnedClassifierSettings settings);

/// The classifier "papers_networks", which needs three.
ContactClassifier papers_networks_stage(PapersClassifierSettings settings);

/// Every locator of flinch, likewise.
std::vector<ContactLocatorStage> locator_stages();

/// Adds what all classifiers and locators read: the contact that lasts, the fast observer, features and
/// evidence.
ContactPorts add_isolation(const StageContext& site, const EstimatePorts& given,
                           OutputPort<ContactDetection> detection);

}  // namespace flinch
