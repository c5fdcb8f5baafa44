#pragma once

#include <memory>

#include "systems/contact/neural_network.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct LearnedClassifierSettings {
  /// Says by `evidence_features` how likely each class is; softmax_of_rows.
  std::shared_ptr<const NeuralNetwork> network;
  double accept = 0.9;  ///< least probability to act upon
  Time window = 10ms;   ///< from the detection; what is said by then stands until the contact ends
  /// Least residual e^T S^-1 e of any class at which no single contact explains the wrench.
  double largest_residual = 15.0;
};

/// Classifies the contact by a network that has learned what the evidence of the model is worth: that of the
/// wrench and of how it has grown. At each tick of the window it says what the evidence of that tick tells;
/// evidence that is not valid changes nothing.
class LearnedClassifier final : public System {
  State<ContactClassification> last_ = state<ContactClassification>("last");

 public:
  /// Throws SetupError without a network, or for one that is told other features.
  LearnedClassifier(const std::shared_ptr<const ParallelRobot>& robot, LearnedClassifierSettings settings);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<ContactEvidence> evidence = input<ContactEvidence>("evidence");
  InputPort<ContactEvidence> change_evidence = input<ContactEvidence>("change_evidence");  ///< of its growth
  InputPort<ContactEvidence> change_before_evidence = input<ContactEvidence>("change_before_evidence");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");  ///< that the evidence is of
  OutputPort<ContactClassification> classification = output<&LearnedClassifier::classify>(
      "classification", clock, phase, evidence, change_evidence, change_before_evidence, wrench, last_);

 private:
  Update remember_ = keep(last_, classification);

  void classify(Time now, const ContactPhase& contact, const ContactEvidence& seen,
                const ContactEvidence& change, const ContactEvidence& change_before,
                const WrenchEstimate& estimate, const ContactClassification& last,
                ContactClassification& result) const;

  ContactClasses classes_;
  int translations_;
  LearnedClassifierSettings settings_;
};

}  // namespace flinch
