#include "systems/motion/retraction.h"

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const RetractionSettings& settings) {
  Findings found("retraction: ");
  found.require(settings.distance > 0, "distance must be positive");
  found.require(settings.angle > 0, "angle must be positive");
  found.require(settings.force_to_go_by > 0, "force_to_go_by must be positive");
  found.require(can_be_planned_with(settings.limits.translation), "limits of translation must be positive");
  found.require(can_be_planned_with(settings.limits.rotation), "limits of rotation must be positive");
  return found.take();
}

}  // namespace

PlatformVector retraction_displacement(const PlatformVector& wrench, int translations,
                                       const RetractionSettings& settings) noexcept {
  const auto force = wrench.head(translations);
  const auto moment = wrench.tail(wrench.size() - translations);
  PlatformVector displacement = PlatformVector::Zero(wrench.size());
  if (force.norm() >= settings.force_to_go_by) {
    displacement.head(translations) = settings.distance * force.normalized();  // [SafePR] (23)
  } else if (moment.size() > 0 && moment.norm() > 0) {
    displacement.tail(moment.size()) = settings.angle * moment.normalized();
  }
  return displacement;
}

Retraction::Retraction(std::shared_ptr<const ParallelRobot> robot, const RetractionSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  throw_if_any(problems(settings));
}

PlatformVector Retraction::displacement(const WrenchEstimate& contact) const {
  const PlatformVector& wrench = contact.wrench_in_base;
  const bool usable = contact.valid && wrench.size() == robot_->dof() && wrench.allFinite();
  if (!usable) return PlatformVector::Zero(robot_->dof());
  return retraction_displacement(wrench, robot_->space_dimension(), settings_);
}

void Retraction::plan(Time now, bool begins, const PlatformMotion& motion, const WrenchEstimate& contact,
                      Plan& plan) const {
  plan = {.motion = {}, .begin = now};
  if (!begins || !motion.valid() || !robot_->space().contains(motion.pose)) return;
  plan.motion = PoseMotion::plan(robot_->space(), motion.pose, motion.velocity, displacement(contact),
                                 settings_.limits);
}

PlatformReference Retraction::evaluate(Time now, const Plan& active) const {
  return active.motion.evaluate(to_seconds(now - active.begin));
}

}  // namespace flinch
