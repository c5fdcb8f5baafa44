#pragma once

#include <string>
#include <vector>

#include "diagrams/link_status.h"
#include "plant/contact_truth.h"
#include "plant/plant_truth.h"
#include "systems/framework/recording.h"
#include "systems/framework/tick_timing.h"
#include "systems/robot/body_id.h"
#include "systems/signals/braking_status.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/followed_task.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/limit_status.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/plausibility.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/target_command.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/workspace_measures.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch::test {

/// All that a verdict looks at, at one tick.
struct Moment {
  PlantTruth truth;
  ContactTruth contact;
  WrenchEstimate estimate;
  ContactDetection detection;
  ReactionState reaction;
  PlatformReference reference;
  GateStatus gate;
  TickTiming timing;
  LinkStatus joints_link;
  Plausibility plausibility;
  BrakingStatus braking;
  ContactClassification classification;
  FollowedTask task;
  WorkspaceMeasures measured;  ///< by the controller
  WorkspaceMeasures true_measures;
  LimitStatus limits;
  TorqueCommand torque;
  OperatorCommand pressed;
  TargetCommand target;
};

/// A recording made up tick by tick: the robot rests where it shall, nothing touches it and nothing is
/// detected, until something else is said.
class SyntheticRun {
 public:
  explicit SyntheticRun(int milliseconds) : moments_(static_cast<std::size_t>(milliseconds), quiet()) {}

  /// The tick at `milliseconds`.
  Moment& at(int milliseconds) { return moments_[static_cast<std::size_t>(milliseconds)]; }

  /// The pylon pushes `body` with `force` [N] along x, from the first tick to the last.
  SyntheticRun& touch(BodyId body, int first, int last, double force) {
    for (int k = first; k <= last; ++k) {
      at(k).contact.strongest.body = body.index();
      at(k).contact.strongest.force_in_base = Eigen::Vector2d(force, 0.0);
      at(k).truth.wrench_in_base[0] = at(k).contact.wrench_in_base[0] = force;
    }
    return *this;
  }

  /// Two obstacles: the first touches `body` with `force` [N] along x as well as what else touches, from the
  /// first tick to the last; what touches already is the second.
  SyntheticRun& touch_too(BodyId body, int first, int last, double force) {
    for (int k = first; k <= last; ++k) {
      ContactTruth& contact = at(k).contact;
      TouchTruth touch = contact.second;
      touch.body = body.index();
      touch.obstacle = 0;
      touch.force_in_base = Eigen::Vector2d(force, 0.0);
      if (contact.strongest.body >= 0) contact.strongest.obstacle = 1;
      contact.add(touch);
      contact.wrench_in_base[0] += force;
      at(k).truth.wrench_in_base[0] += force;
    }
    return *this;
  }

  /// A wrench acts on the platform without touching it, from the first tick to the last.
  SyntheticRun& push(int first, int last, const Eigen::Vector3d& wrench) {
    for (int k = first; k <= last; ++k) at(k).truth.wrench_in_base = at(k).contact.wrench_in_base + wrench;
    return *this;
  }

  /// The estimate is above the reaction threshold from the first tick to the last; the detector latches.
  SyntheticRun& notice(int first, int last) {
    for (int k = first; k < static_cast<int>(moments_.size()); ++k) {
      at(k).detection.level = ContactLevel::reaction;
      if (k <= last) at(k).detection.present_level = ContactLevel::reaction;
    }
    return *this;
  }

  /// From the first tick on the robot takes what touches it for this class, and is sure by 0.97.
  SyntheticRun& classify(int first, int number) {
    for (int k = first; k < static_cast<int>(moments_.size()); ++k) {
      ContactClassification& said = at(k).classification;
      said.valid = said.accepted = true;
      said.most_likely = number;
      said.probability = ClassVector::Zero(classes.count());
      said.probability[number] = 0.97;
    }
    return *this;
  }

  Recording recording() const {
    Recording recording;
    recording.period = 1ms;
    recording.attributes = {{"obstacle.1.name", "hand"}, {"obstacle.2.name", "crate"}};
    for (int i = 0; i < classes.count(); ++i)
      recording.attributes["contact.classes"] += classes.name(i) + " ";
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      recording.time_ns.push_back(1'000'000 * static_cast<std::int64_t>(k));
    }
    recording.signals = {signal("truth", &Moment::truth),
                         signal("contact", &Moment::contact),
                         signal("wrench", &Moment::estimate),
                         signal("detection", &Moment::detection),
                         signal("reaction", &Moment::reaction),
                         signal("reference", &Moment::reference),
                         signal("gate", &Moment::gate),
                         signal("tick_timing", &Moment::timing),
                         signal("joints_link", &Moment::joints_link),
                         signal("plausibility", &Moment::plausibility),
                         signal("braking", &Moment::braking),
                         signal("classification", &Moment::classification),
                         signal("reaction_task", &Moment::task),
                         signal("measures", &Moment::measured),
                         signal("true_measures", &Moment::true_measures),
                         signal("limits", &Moment::limits),
                         signal("torque_command", &Moment::torque),
                         signal("operator", &Moment::pressed),
                         signal("target", &Moment::target)};
    return recording;
  }

 private:
  static constexpr ContactClasses classes{7, 3};

  static Moment quiet() {
    const PlatformVector zero = PlatformVector::Zero(3);
    Moment moment;
    moment.contact.clear(3, 2);
    moment.truth.valid = moment.contact.valid = moment.detection.valid = true;
    moment.truth.pose = moment.truth.velocity = zero;
    moment.truth.wrench_in_base = moment.contact.wrench_in_base = zero;
    moment.estimate.valid = moment.reference.valid = true;
    moment.estimate.wrench_in_base = moment.reference.pose = zero;
    moment.reaction.mode = ReactionMode::nominal;
    moment.gate.phase = GatePhase::open;
    return moment;
  }

  template <class Value>
  Signal signal(const std::string& path, Value Moment::*value) const {
    Signal signal{path, row_layout<Value>(), {}};
    signal.rows.resize(moments_.size() * signal.layout.numbers);
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      write_row(moments_[k].*value, signal.rows.data() + k * signal.layout.numbers);
    }
    return signal;
  }

  std::vector<Moment> moments_;
};

}  // namespace flinch::test
