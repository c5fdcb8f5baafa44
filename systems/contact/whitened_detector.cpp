#include "systems/contact/whitened_detector.h"

#include <algorithm>
#include <string>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void find_problems(const std::string& owner, const MahalanobisThreshold& settings, Findings& findings) {
  findings.positive(owner + ".threshold", settings.threshold);
  findings.positive(owner + ".noise", settings.errors.noise, "Nm or N");
  findings.not_negative(owner + ".speed", settings.errors.speed, "Nm s/rad or N s/m");
  findings.not_negative(owner + ".load", settings.errors.load);
  findings.not_negative(owner + ".torque", settings.errors.torque);
  findings.not_negative(owner + ".friction", settings.errors.friction);
  findings.not_negative(owner + ".lag", settings.errors.lag, "s");
  findings.not_negative(owner + ".rest", settings.errors.rest, "Nm or N");
  findings.not_negative(owner + ".acceleration", settings.errors.acceleration, "rad/s^2 or m/s^2");
  findings.not_negative(owner + ".turning", settings.errors.turning);
}

void find_problems(const OnsetThreshold& settings, Findings& findings) {
  findings.positive("onset.threshold", settings.threshold);
  findings.positive("onset.innovation", settings.course.innovation);
  findings.finite("onset.prediction", settings.course.prediction);
}

std::vector<std::string> problems(const WhitenedDetectorSettings& settings) {
  Findings found;
  find_problems("level", settings.level, found);
  find_problems("change", settings.change, found);
  if (settings.smoothed) find_problems("smoothed", *settings.smoothed, found);
  if (settings.onset) find_problems(*settings.onset, found);
  found.positive("tracking", settings.tracking.rate, "1/s");
  found.positive("smoothing", settings.tracking.smoothing, "1/s");
  found.positive("resting_rate", settings.tracking.resting_rate, "rad/s or m/s");
  const FilterResponse& answer = settings.tracking.answer;
  found.require(answer.filters >= 0 && answer.filters <= FilterResponse::most,
                "tracking.answer has more filters than can be followed, or fewer than none");
  if (answer.filters > 0) found.positive("tracking.answer", answer.rate, "1/s");
  found.require(settings.hard.force > 0.0 && settings.hard.moment > 0.0,
                "hard has a threshold that is not positive [N, Nm]");
  return found.take();
}

bool exceeds(const DriveLoad& load, const DriveResidual& seen, const MahalanobisThreshold& limit) {
  return mahalanobis_distance(load, seen, limit.errors) >= limit.threshold;
}

}  // namespace

WhitenedDetector::WhitenedDetector(const std::shared_ptr<const ParallelRobot>& robot,
                                   const WhitenedDetectorSettings& settings)
    : settings_(settings), hard_(of_components(settings.hard, *robot)) {
  throw_if_any(problems(settings));
  if (settings.onset) onset_.emplace(settings.change.errors, settings.onset->course, settings.tracking);
  keep(Every{settings_.tracking.sampling.period}, memory_, next_);
  keep(Every{settings_.tracking.sampling.period}, onsets_, next_onsets_);
  keep(Every{settings_.tracking.sampling.period}, previous_, contact);
}

void WhitenedDetector::follow_onsets(const ResidualMemory& next, const OnsetMemory& onsets,
                                     OnsetMemory& result) const {
  result.samples = 0;
  if (onset_) onset_->follow(next.seen, onsets, result);
}

bool WhitenedDetector::is_touched(const ResidualSample& seen, const OnsetMemory& onsets) const {
  if (exceeds(seen.load, seen.level, settings_.level)) return true;
  const auto& smoothed = settings_.smoothed;
  if (smoothed && seen.smooth && exceeds(seen.load, seen.smoothed, *smoothed)) return true;
  if (onset_) return onset_->mahalanobis_distance(onsets) >= settings_.onset->threshold;
  return seen.settled && exceeds(seen.load, seen.change, settings_.change);
}

void WhitenedDetector::detect(const ResidualMemory& next, const OnsetMemory& onsets,
                              const WrenchEstimate& estimate, const ResetCommand& command,
                              const ContactDetection& previous, Time now, ContactDetection& result) const {
  result = command.reset ? ContactDetection() : previous;
  const bool has_estimate = estimate.valid && !estimate.health.fallen_back;
  result.valid = next.started && has_estimate && estimate.wrench_in_base.size() == hard_.size();
  result.present_level = ContactLevel::none;
  if (result.valid && next.seen.is_new && is_touched(next.seen, onsets)) {
    const bool hard = (estimate.wrench_in_base.array().abs() >= hard_.array()).any();
    result.present_level = hard ? ContactLevel::hard : ContactLevel::reaction;
  }
  if (result.level == ContactLevel::none && result.present_level != ContactLevel::none) {
    result.detected = now;
    result.wrench_in_base = estimate.wrench_in_base;
  }
  result.level = std::max(result.level, result.present_level);
}

}  // namespace flinch
