#include "experiments/simulated/contact_teller.h"

#include <algorithm>

#include "systems/robot/link_segments.h"

namespace flinch {
namespace {

// Where along the axis of a link a point lies, 0 to 1.
double fraction_of(const Segment& axis, const CartesianVector& point) {
  const CartesianVector along = axis.end - axis.begin;
  const double squared = along.squaredNorm();
  return squared > 0.0 ? std::clamp(along.dot(point - axis.begin) / squared, 0.0, 1.0) : 0.0;
}

/// A force on a link of the leg that comes from between both: it pushes the link away from the other one.
bool comes_from_between(const Kinematics& at, BodyId link, const CartesianVector& force) {
  const LegPoints& points = at.legs[static_cast<std::size_t>(link.leg())];
  const CartesianVector& other_end = link.is_link1() ? points.coupling_joint : points.base_joint;
  const Segment axis = link_segment(at, link);
  const CartesianVector along = (axis.end - axis.begin).normalized();
  const CartesianVector to_other = other_end - points.passive_joint;
  return force.dot(to_other - along.dot(to_other) * along) < 0.0;
}

}  // namespace

ContactTeller::ContactTeller(std::shared_ptr<const ParallelRobot> robot, const std::string& made_for)
    : robot_(std::move(robot)), classes_(robot_->body_count(), robot_->legs()) {
  for (int i = 0; i < classes_.count(); ++i) {
    if (classes_.name(i) == made_for) made_for_ = i;
  }
}

bool ContactTeller::begins_a_clamping(const TouchTruth& touch, const PlatformMotion& motion) const {
  const BodyId body = BodyId::from_index(touch.body);
  if (!classes_.is_clamping(made_for_) || classes_.leg(made_for_) != body.leg() || !motion.valid())
    return false;
  Kinematics now;
  robot_->kinematics(motion.pose, motion.velocity, now);
  return now.reachable && comes_from_between(now, body, touch.force_in_base);
}

ContactClassification ContactTeller::classify(const ContactTruth& truth, const PlatformMotion& motion) const {
  ContactClassification told;
  told.acquired = truth.acquired;
  told.probability = ClassVector::Zero(classes_.count());
  const int body = truth.strongest.body;
  if (!truth.valid || !truth.in_contact || body < 0) return told;
  const int leg = BodyId::from_index(body).leg();
  const bool clamps = leg >= 0 && (truth.clamping || begins_a_clamping(truth.strongest, motion));
  told.most_likely = clamps ? classes_.clamping(leg) : body;
  told.probability[told.most_likely] = 1.0;
  told.valid = told.accepted = true;
  return told;
}

ContactLocation ContactTeller::locate(const ContactTruth& truth, const PlatformMotion& motion) const {
  ContactLocation told;
  told.acquired = truth.acquired;
  const TouchTruth& touch = truth.strongest;
  if (!truth.valid || !truth.in_contact || touch.body < 0 || !motion.valid()) return told;
  told.valid = told.located = true;
  told.body = touch.body;
  told.point_in_base = touch.point_in_base;
  told.force_in_base = touch.force_in_base;
  const BodyId body = BodyId::from_index(touch.body);
  if (body.is_platform()) return told;
  Kinematics now;
  robot_->kinematics(motion.pose, motion.velocity, now);
  told.fraction = now.reachable ? fraction_of(link_segment(now, body), touch.point_in_base) : 0.0;
  return told;
}

}  // namespace flinch
