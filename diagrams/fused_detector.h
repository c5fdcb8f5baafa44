#pragma once

#include <string>

#include "diagrams/control_stages.h"
#include "systems/contact/residual_sample.h"

namespace flinch {

/// How the residual of an estimator is followed. `disturbance_filter` answers through its three poles; of the
/// others no filter is known, and their errors are expected at once.
ResidualTracking tracking_of(const std::string& estimator, const ContactControlSettings& settings);

/// A stage that detects what any of `ContactControlSettings::fused_detector.residuals` shows: a
/// `WhitenedDetector` on each, and either of them. An estimator that does not run is added for it alone. Hard
/// contacts are those of `contact_detector`. Throws SetupError for an estimator that there is not, and where
/// it is followed and has no residual.
OutputPort<ContactDetection> add_fused_detector(const StageContext& site, const EstimatePorts& given);

}  // namespace flinch
