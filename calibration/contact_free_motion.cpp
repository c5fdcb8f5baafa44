#include "calibration/contact_free_motion.h"

#include <algorithm>
#include <cstdio>

#include "experiments/verdict/recorded_run.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"

namespace flinch {
namespace {

constexpr double longest_pause = 1.0;  // of a motion [s]; a robot that waits for longer stands still

std::string at(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "at %.3f s", seconds);
  return text;
}

bool rests(const PlatformReference& reference) {
  return reference.valid && reference.velocity.isZero(0.0) && reference.acceleration.isZero(0.0);
}

}  // namespace

std::vector<bool> nominal_samples(const Recording& recording, const ConfigurationSpace& space) {
  const RecordedRun run(recording, space);
  std::vector<bool> nominal(run.size());
  const auto reference = read<PlatformReference>(recording, "reference");
  double moved_last = 0.0;  // [s]
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const RunSample now = run[k];
    if (now.is_touched()) {
      throw SetupError("something touched or pushed the robot " + at(now.time) +
                       "; thresholds come from motion without contact");
    }
    if (run.witness() == Witness::none && now.detection.level != ContactLevel::none) {
      throw SetupError("the robot detected a contact " + at(now.time) +
                       ", and nobody knows whether there was one; record with higher thresholds in "
                       "control.contact_detector");
    }
    if (k == 0 || !rests(reference[k])) moved_last = now.time;
    nominal[k] = now.mode == ReactionMode::nominal && now.time - moved_last <= longest_pause;
  }
  return nominal;
}

std::vector<bool> moving_samples(const Recording& estimates) {
  constexpr double least_share = 0.02, longest_pause = 1.0;  // [1], [s]
  const auto motion = read<PlatformMotion>(estimates, "motion");
  std::vector<double> speed(motion.size());
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const PlatformMotion now = motion[k];
    speed[k] = now.valid() ? now.velocity.norm() : 0.0;
  }
  const double most = speed.empty() ? 0.0 : *std::max_element(speed.begin(), speed.end());
  std::vector<bool> moving(speed.size());
  double moved_last = -2.0 * longest_pause;
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const double now = to_seconds(Time(estimates.time_ns[k]));
    if (speed[k] > least_share * most) moved_last = now;
    moving[k] = now - moved_last <= longest_pause;
  }
  return moving;
}

std::vector<std::pair<std::string, std::string>> estimates_of(const Recording& recording) {
  std::vector<std::pair<std::string, std::string>> found;
  const auto followed = recording.attributes.find("control.estimator");
  if (recording.find("wrench") != nullptr && followed != recording.attributes.end()) {
    found.emplace_back(followed->second, "wrench");
  }
  const std::string others = "wrench_";
  for (const Signal& signal : recording.signals) {
    if (signal.path.starts_with(others)) found.emplace_back(signal.path.substr(others.size()), signal.path);
  }
  if (found.empty()) throw SetupError("the recording holds no estimates of named estimators");
  return found;
}

}  // namespace flinch
