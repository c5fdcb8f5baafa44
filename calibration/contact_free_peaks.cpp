#include "calibration/contact_free_peaks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/verdict/recorded_estimate.h"
#include "experiments/verdict/recorded_run.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"

namespace flinch {
namespace {

std::string at(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "at %.3f s", seconds);
  return text;
}

/// Whether each sample belongs to the nominal motion. Throws SetupError for contact.
std::vector<bool> nominal_samples(const Recording& recording, const ConfigurationSpace& space) {
  const RecordedRun run(recording, space);
  std::vector<bool> nominal(run.size());
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const RunSample now = run[k];
    if (now.is_touched()) {
      throw SetupError("something touched or pushed the robot " + at(now.time) +
                       "; thresholds come from motion without contact");
    }
    if (run.witness() == Witness::none && now.detection.level != ContactLevel::none) {
      throw SetupError("the robot noticed a contact " + at(now.time) +
                       ", and nobody knows whether there was one; record with higher thresholds in "
                       "control.contact_detector");
    }
    nominal[k] = now.mode == ReactionMode::nominal;
  }
  return nominal;
}

/// Names of the estimators and the signals of what they say.
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

}  // namespace

std::vector<EstimatorPeaks> contact_free_peaks(const Recording& recording, const ConfigurationSpace& space,
                                               Time stretch) {
  const std::vector<bool> nominal = nominal_samples(recording, space);
  const auto length = static_cast<std::size_t>(std::max<std::int64_t>(1, stretch / recording.period));
  std::vector<EstimatorPeaks> all;
  for (const auto& [estimator, path] : estimates_of(recording)) {
    EstimatorPeaks& peaks = all.emplace_back();
    peaks.estimator = estimator;
    const auto estimates = read<RecordedEstimate>(recording, path);
    std::size_t samples = 0;  // of the present stretch
    double force = 0.0, moment = 0.0;
    for (std::size_t k = 0; k < estimates.size(); ++k) {
      const RecordedEstimate estimate = estimates[k];
      const bool counts = estimate.valid && nominal[k] && estimate.wrench_in_base.size() == space.dimension();
      if (!counts) {
        samples = 0;
        continue;
      }
      if (samples == 0) force = moment = 0.0;
      force = std::max(force, largest_component(estimate.wrench_in_base.head(space.translations())));
      moment = std::max(moment, largest_component(estimate.wrench_in_base.tail(space.rotations())));
      if (++samples < length) continue;
      peaks.force.push_back(force);
      if (space.rotations() > 0) peaks.moment.push_back(moment);
      samples = 0;
    }
  }
  return all;
}

}  // namespace flinch
