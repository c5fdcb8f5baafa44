#include "systems/contact/decision_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/line_of_action.h"

namespace flinch {
namespace {

/// The leg whose coupling joint the line of action passes; of two that it passes alike, the one whose drive
/// feels more.
int nearest_leg(const ContactFeatures& features, double tie) {
  Eigen::Index nearest = 0;
  const double least = features.distance.minCoeff(&nearest);
  for (Eigen::Index leg = 0; leg < features.distance.size(); ++leg) {
    const bool as_near = features.distance[leg] <= least + tie;
    if (as_near && std::abs(features.drive_torque[leg]) > std::abs(features.drive_torque[nearest]))
      nearest = leg;
  }
  return static_cast<int>(nearest);
}

}  // namespace

int decide(const ContactFeatures& features, const JointVector& elbow, const ContactClasses& classes,
           const DecisionTreeSettings& settings) noexcept {
  const bool complete = features.valid && features.distance.size() == classes.legs() &&
                        features.angle.size() == classes.legs() && elbow.size() == classes.legs() &&
                        features.drive_torque.size() >= classes.legs() && classes.legs() > 0;
  if (!complete) return -1;
  const int leg = nearest_leg(features, settings.tie);
  if (features.distance[leg] > settings.leg_distance) return ContactClasses::collision(BodyId::platform());
  if (elbow[leg] > settings.clamping_elbow) return classes.clamping(leg);
  Eigen::Index hardest = 0;
  features.drive_torque.cwiseAbs().maxCoeff(&hardest);
  const bool one_drive = features.affected_drives <= 1 && hardest == leg;
  const double from_link = std::min(features.angle[leg], std::numbers::pi - features.angle[leg]);
  const bool first = one_drive || from_link < settings.parallel;
  return ContactClasses::collision(first ? BodyId::link1(leg) : BodyId::link2(leg));
}

JointVector elbow_angles(const Kinematics& kinematics, int legs) noexcept {
  JointVector angles(legs);
  for (int i = 0; i < legs; ++i) {
    const LegPoints& leg = kinematics.legs[static_cast<std::size_t>(i)];
    angles[i] = angle_between(leg.passive_joint - leg.base_joint, leg.coupling_joint - leg.passive_joint);
  }
  return angles;
}

DecisionTree::DecisionTree(const std::shared_ptr<const ParallelRobot>& robot,
                           const DecisionTreeSettings& settings)
    : classes_(robot->body_count(), robot->legs()), settings_(settings) {
  Findings found("decision tree: ");
  found.positive("leg_distance", settings.leg_distance, "m");
  found.not_negative("tie", settings.tie, "m");
  found.positive("parallel", settings.parallel, "rad");
  found.positive("clamping_elbow", settings.clamping_elbow, "rad");
  for (const double right : {settings.right_of_platform, settings.right_of_link1, settings.right_of_link2,
                             settings.right_of_clamping})
    found.require(right >= 0.0 && right <= 1.0, "shares of right answers must be between 0 and 1");
  found.require(settings.accept > 0.0 && settings.accept <= 1.0, "accept must be above 0 and at most 1");
  throw_if_any(found.take());
}

double DecisionTree::share_right(int said) const {
  if (classes_.is_clamping(said)) return settings_.right_of_clamping;
  const BodyId body = ContactClasses::body(said);
  if (body.is_platform()) return settings_.right_of_platform;
  return body.is_link1() ? settings_.right_of_link1 : settings_.right_of_link2;
}

ContactClassification DecisionTree::classify(const ContactPhase& contact, const ContactFeatures& now,
                                             const Kinematics& at, const ContactClassification& last) const {
  if (!contact.active) return {};
  if (last.valid) return last;
  ContactClassification result;
  if (!at.valid) return result;
  result.most_likely = decide(now, elbow_angles(at, classes_.legs()), classes_, settings_);
  if (result.most_likely < 0) return result;
  result.acquired = now.acquired;
  result.valid = true;
  const double right = share_right(result.most_likely);
  result.probability.setConstant(classes_.count(), (1.0 - right) / (classes_.count() - 1));
  result.probability[result.most_likely] = right;
  result.accepted = result.confidence() >= settings_.accept;
  return result;
}

}  // namespace flinch
