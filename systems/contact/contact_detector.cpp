#include "systems/contact/contact_detector.h"

#include <algorithm>
#include <string>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

std::vector<std::string> problems(const ContactDetectorSettings& settings) {
  const auto& [reaction, hard, period] = settings;
  Findings found;
  found.require(reaction.force.least() > 0.0 && reaction.moment.least() > 0.0,
                "reaction has a threshold that is not positive [N, Nm]");
  found.require(hard.force >= reaction.force.largest() && hard.moment >= reaction.moment.largest(),
                "hard has a threshold below that of reaction [N, Nm]");
  return found.take();
}

PlatformVector of_components(const ReactionThreshold& threshold, const ConfigurationSpace& space) {
  if (!threshold.force.fit(space.translations()) || !threshold.moment.fit(space.rotations()))
    throw SetupError("reaction has neither one threshold for all components nor one for each");
  PlatformVector components = PlatformVector::Zero(space.dimension());
  for (int i = 0; i < space.translations(); ++i) components[i] = threshold.force[i];
  for (int i = 0; i < space.rotations(); ++i) components[space.translations() + i] = threshold.moment[i];
  return components;
}

}  // namespace

PlatformVector of_components(const WrenchThreshold& threshold, const ParallelRobot& robot) {
  PlatformVector components = PlatformVector::Constant(robot.dof(), threshold.moment);
  components.head(robot.space().translations()).setConstant(threshold.force);
  return components;
}

ContactDetector::ContactDetector(const std::shared_ptr<const ParallelRobot>& robot,
                                 const ContactDetectorSettings& settings)
    : reaction_(of_components(settings.reaction, robot->space())),
      hard_(of_components(settings.hard, *robot)) {
  throw_if_any(problems(settings));
  keep(Every{settings.period}, previous_, contact);
}

ContactLevel ContactDetector::level(const PlatformVector& estimate) const {
  if ((estimate.array().abs() >= hard_.array()).any()) return ContactLevel::hard;
  if ((estimate.array().abs() >= reaction_.array()).any()) return ContactLevel::reaction;
  return ContactLevel::none;
}

ContactDetection ContactDetector::detect(const WrenchEstimate& estimate, const ResetCommand& command,
                                         const ContactDetection& previous, Time now) const {
  ContactDetection result = command.reset ? ContactDetection() : previous;
  result.valid = estimate.valid && estimate.wrench_in_base.size() == reaction_.size() &&
                 estimate.wrench_in_base.allFinite();
  result.present_level = result.valid ? level(estimate.wrench_in_base) : ContactLevel::none;
  if (result.level == ContactLevel::none && result.present_level != ContactLevel::none) {
    result.detected = now;
    result.wrench_in_base = estimate.wrench_in_base;
  }
  result.level = std::max(result.level, result.present_level);
  return result;
}

}  // namespace flinch
