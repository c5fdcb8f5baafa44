#pragma once

#include <memory>

#include "systems/contact/neural_network.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/contact_window.h"

namespace flinch {

struct LearnedClassifierSettings {
  /// Says by `evidence_features` how likely each class is; softmax_of_rows.
  std::shared_ptr<const NeuralNetwork> network;
  double accept = 0.9;  ///< least probability to act upon
  /// Least size of the wrench to act upon (WrenchUncertainty::size): that of which the network has learned.
  /// Of smaller ones it may be sure and wrong.
  double least_wrench = 0.0;
  Time window = 10ms;  ///< from the detection; what is said by then stands until the contact ends
  /// Least residual e^T S^-1 e of any class at which no single contact explains the wrench.
  double largest_residual = 15.0;
};

/// Classifies the contact by a network that has learned what the evidence of the model is worth: that of the
/// wrench and of its growth, and how it has come about. At each tick of the window it says what that tick
/// tells; what is not valid changes nothing.
class LearnedClassifier final : public System {
  State<ContactClassification> last_ = state<ContactClassification>("last");

 public:
  /// Throws SetupError without a network, or for one that is told other features.
  LearnedClassifier(std::shared_ptr<const ParallelRobot> robot, LearnedClassifierSettings settings);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<ContactEvidence> evidence = input<ContactEvidence>("evidence");
  InputPort<ContactEvidence> growth_evidence = input<ContactEvidence>("growth_evidence");
  InputPort<ContactWindow> course = input<ContactWindow>("course");  ///< of the wrench that they are of
  OutputPort<ContactClassification> classification = output<&LearnedClassifier::classify>(
      "classification", clock, phase, kinematics, evidence, growth_evidence, course, last_);

 private:
  Update remember_ = keep(last_, classification);

  void classify(Time now, const ContactPhase& contact, const Kinematics& pose, const ContactEvidence& seen,
                const ContactEvidence& growth, const ContactWindow& how, const ContactClassification& last,
                ContactClassification& result) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ContactClasses classes_;
  LearnedClassifierSettings settings_;
};

}  // namespace flinch
