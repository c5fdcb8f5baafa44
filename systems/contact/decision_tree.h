#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_features.h"
#include "systems/signals/contact_phase.h"

namespace flinch {

/// Limits of [PAR], and how often its answers are right.
struct DecisionTreeSettings {
  double leg_distance = 0.05;    ///< epsilon_d: nearer to a coupling joint a line of action is that leg's [m]
  double tie = 0.005;            ///< legs whose distances differ by less are told apart by their drives [m]
  double parallel = 0.61086524;  ///< epsilon_alpha, 35 degrees: between force and last link [rad]
  double clamping_elbow = 2.26892803;  ///< 130 degrees: beyond, a leg may clamp something [rad]
  /// Shares of answers that are right, by what they name, of contacts of which as many are meant for the
  /// platform, first links, second links and gaps: measured on realistic robots of the planar rig by
  /// tests/campaign/isolation, which prints and checks them.
  double right_of_platform = 0.99;  ///< 116 of 116
  double right_of_link1 = 0.57;     ///< 490 of 854
  double right_of_link2 = 0.50;     ///< 302 of 600
  double right_of_clamping = 0.29;  ///< 78 of 272
  double accept = 0.9;              ///< least probability to act upon
};

/// What was touched by a few comparisons: the platform where the line of action keeps off all coupling
/// joints; clamping where the leg is folded; the first link where one drive feels it alone, or the force is
/// parallel to the second link; else the second link. `elbow`: of each leg, how far its second link is turned
/// from the first, 0 to pi [rad]. -1: features that are not valid.
int decide(const ContactFeatures& features, const JointVector& elbow, const ContactClasses& classes,
           const DecisionTreeSettings& settings) noexcept;

/// How far the second link of each leg is turned from its first, 0 to pi [rad].
JointVector elbow_angles(const Kinematics& kinematics, int legs) noexcept;

/// Classifies the contact by the decision tree, from the features at its detection; its answer stands until
/// the contact ends. As probable as its answers of that sort are right; the rest is shared evenly by all
/// other classes.
class DecisionTree final : public System {
  State<ContactClassification> last_ = state<ContactClassification>("last");

 public:
  DecisionTree(const std::shared_ptr<const ParallelRobot>& robot, const DecisionTreeSettings& settings);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<ContactFeatures> features = input<ContactFeatures>("features");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  OutputPort<ContactClassification> classification =
      output<&DecisionTree::classify>("classification", phase, features, kinematics, last_);

 private:
  Update remember_ = keep(last_, classification);

  ContactClassification classify(const ContactPhase& contact, const ContactFeatures& now,
                                 const Kinematics& at, const ContactClassification& last) const;
  double share_right(int said) const;

  ContactClasses classes_;
  DecisionTreeSettings settings_;
};

}  // namespace flinch
