#include "calibration/contact_free_peaks.h"

#include <fmt/core.h>

#include <algorithm>

#include "calibration/contact_free_motion.h"
#include "calibration/gumbel.h"
#include "experiments/verdict/recorded_estimate.h"
#include "experiments/verdict/recorded_run.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"

namespace flinch {
namespace {

/// Throws where one of the peaks, of stretches that begin at these times [s], cannot be of the same motion as
/// the others.
void require_alike(const std::string& estimator, const std::vector<double>& peaks,
                   const std::vector<double>& begin, const char* quantity, const char* unit) {
  constexpr std::size_t fewest = 20;     // that tell what is usual
  constexpr double least_chance = 1e-6;  // of a recording with so large a peak
  if (peaks.size() < fewest) return;
  const Gumbel usual = fit_gumbel_to_quartiles(peaks);
  if (usual.scale <= 0.0) return;
  const auto largest = std::max_element(peaks.begin(), peaks.end());
  const double chance = static_cast<double>(peaks.size()) * usual.probability_above(*largest);
  if (chance >= least_chance) return;
  throw SetupError(
      fmt::format("{}: a {} of {:.3g} {} after {:.1f} s is no error like those of the other {} stretches; "
                  "something touched the robot then, it took up a load, or it failed: record without that",
                  estimator, quantity, *largest, unit,
                  begin[static_cast<std::size_t>(largest - peaks.begin())], peaks.size() - 1));
}

/// Of the samples that count. `is_watched`: somebody knows that nothing touched the robot in them.
std::vector<EstimatorPeaks> peaks_where(const std::vector<bool>& nominal, bool is_watched,
                                        const Recording& recording, const ConfigurationSpace& space,
                                        Time stretch) {
  const auto length = static_cast<std::size_t>(std::max<std::int64_t>(1, stretch / recording.period));
  std::vector<EstimatorPeaks> all;
  for (const auto& [estimator, path] : estimates_of(recording)) {
    EstimatorPeaks& peaks = all.emplace_back();
    peaks.estimator = estimator;
    const auto estimates = read<RecordedEstimate>(recording, path);
    std::size_t samples = 0;  // of the present stretch
    PlatformVector largest;   // of it
    peaks.components.resize(static_cast<std::size_t>(space.dimension()));
    std::vector<double> begin;  // of each stretch [s]
    for (std::size_t k = 0; k < estimates.size(); ++k) {
      const RecordedEstimate estimate = estimates[k];
      const bool counts = estimate.valid && nominal[k] && estimate.wrench_in_base.size() == space.dimension();
      if (!counts) {
        samples = 0;
        continue;
      }
      if (samples == 0) largest = PlatformVector::Zero(space.dimension());
      largest = largest.cwiseMax(estimate.wrench_in_base.cwiseAbs());
      if (++samples < length) continue;
      peaks.force.push_back(largest_component(largest.head(space.translations())));
      if (space.rotations() > 0) peaks.moment.push_back(largest_component(largest.tail(space.rotations())));
      for (int i = 0; i < space.dimension(); ++i)
        peaks.components[static_cast<std::size_t>(i)].push_back(largest[i]);
      begin.push_back(to_seconds(Time(recording.time_ns[k + 1 - length])));
      samples = 0;
    }
    if (is_watched) continue;
    require_alike(estimator, peaks.force, begin, "force", "N");
    require_alike(estimator, peaks.moment, begin, "moment", "Nm");
  }
  return all;
}

}  // namespace

std::vector<EstimatorPeaks> contact_free_peaks(const Recording& recording, const ConfigurationSpace& space,
                                               Time stretch) {
  const bool is_watched = RecordedRun(recording, space).witness() != Witness::none;
  return peaks_where(nominal_samples(recording, space), is_watched, recording, space, stretch);
}

std::vector<EstimatorPeaks> contact_free_peaks(const Recording& estimates, const std::vector<bool>& counts,
                                               const ConfigurationSpace& space, Time stretch) {
  return peaks_where(counts, false, estimates, space, stretch);
}

}  // namespace flinch
