#pragma once

#include <memory>

#include "systems/contact/neural_network.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_features.h"
#include "systems/signals/contact_phase.h"

namespace flinch {

/// The networks of [SafePR] III, each softmax_of_outputs.
struct PapersClassifierSettings {
  std::shared_ptr<const NeuralNetwork> clamping;  ///< of `clamping_vector`: collision, clamping; III-E1
  std::shared_ptr<const NeuralNetwork> chain;     ///< of `clamping_vector`: which leg is clamped; III-E2
  std::shared_ptr<const NeuralNetwork> body;      ///< of `feature_vector`: which body is touched; III-C
  double accept = 0.9;                            ///< least probability to act upon
  /// Least size of the wrench to be asked about (WrenchUncertainty::size): that of which they have learned.
  double least_wrench = 0.0;
};

/// Classifies the contact as the papers do: whether a leg is clamped; then which leg, or with which body the
/// robot collides. The first features after the detection decide whose wrench is large enough; the answer
/// stands until the contact ends.
class PapersClassifier final : public System {
  State<ContactClassification> last_ = state<ContactClassification>("last");

 public:
  /// Throws SetupError without one of the networks, or for one whose inputs or answers are not those of the
  /// robot.
  PapersClassifier(const std::shared_ptr<const ParallelRobot>& robot, PapersClassifierSettings settings);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<ContactFeatures> features = input<ContactFeatures>("features");
  OutputPort<ContactClassification> classification =
      output<&PapersClassifier::classify>("classification", clock, phase, features, last_);

  /// p(clamped leg) = p(clamping) p(leg), p(body) = p(collision) p(body). Returns false, and `probability` of
  /// no size, for features that are not valid, not finite or of another robot.
  bool ask(const ContactFeatures& seen, ClassVector& probability) const noexcept;

 private:
  Update remember_ = keep(last_, classification);

  void classify(Time now, const ContactPhase& contact, const ContactFeatures& seen,
                const ContactClassification& last, ContactClassification& result) const;

  ConfigurationSpace space_;
  ContactClasses classes_;
  PapersClassifierSettings settings_;
};

}  // namespace flinch
