#pragma once

#include <memory>
#include <vector>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_phase.h"

namespace flinch {

struct ModelClassifierSettings {
  double accept = 0.9;  ///< least probability to act upon
  Time window = 10ms;   ///< from the detection; what has been found by then stands until the contact ends
  /// How many times over the evidence of all ticks together counts as that of one tick: their errors are
  /// mostly the same.
  double independent_ticks = 1.0;
  /// Least residual e^T S^-1 e of any class at which no single contact explains the wrench.
  double largest_residual = 15.0;
};

/// Classifies the contact by the evidence of the model: probabilities of all classes, weighted before by how
/// often each is touched (the biases of `TouchHypothesesSettings`). The evidence of the ticks since the
/// detection is averaged, each with the weight of the square of its force, for it is the growing force that
/// tells. A touch of either link is said of the first one where those of a leg load the robot alike
/// (`legs_of_alike_links`).
class ModelClassifier final : public System {
 public:
  /// What has come together since the contact began.
  struct Memory {
    ClassVector log_evidence;  ///< weighted sum
    double weight = 0.0;
    double residual = 0.0;  ///< weighted sum of the least
    ContactClassification last;
  };

 private:
  State<Memory> memory_ = state<Memory>("memory");

 public:
  ModelClassifier(const std::shared_ptr<const ParallelRobot>& robot, const ModelClassifierSettings& settings);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<ContactEvidence> evidence = input<ContactEvidence>("evidence");

 private:
  Intermediate<Memory> next_ =
      intermediate<&ModelClassifier::advance>("next", clock, phase, evidence, memory_);

 public:
  OutputPort<ContactClassification> classification = output<&ModelClassifier::read>("classification", next_);

 private:
  Update remember_ = keep(memory_, next_);

  void advance(Time now, const ContactPhase& contact, const ContactEvidence& seen, const Memory& memory,
               Memory& next) const;
  ContactClassification read(const Memory& next) const { return next.last; }
  void conclude(const ContactEvidence& seen, Memory& next) const;

  ContactClasses classes_;
  std::vector<bool> alike_;  ///< Of each leg.
  ModelClassifierSettings settings_;
};

}  // namespace flinch
