#include "calibration/contact_free_peaks.h"

#include <algorithm>

#include "calibration/contact_free_motion.h"
#include "experiments/verdict/recorded_estimate.h"
#include "systems/framework/recorded_values.h"

namespace flinch {
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
    const auto seconds = [&recording](std::size_t k) { return to_seconds(Time(recording.time_ns[k])); };
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
      peaks.stretches.push_back({0, seconds(k + 1 - length)});
      samples = 0;
    }
  }
  return all;
}

}  // namespace flinch
