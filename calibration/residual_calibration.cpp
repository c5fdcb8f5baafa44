#include "calibration/residual_calibration.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "calibration/contact_free_motion.h"
#include "calibration/error_course.h"
#include "calibration/error_sizes.h"
#include "calibration/surprise_tail.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"

namespace flinch {
namespace {

constexpr std::size_t most_samples = 60'000;  // of a drive, to which sizes are fitted

/// The signal of the loads of the drives; "" where there is none.
std::string loads_of(const Recording& recording) {
  for (const Signal& signal : recording.signals) {
    if (signal.path.starts_with("load_")) return signal.path;
  }
  return "";
}

/// Whether the sample belongs to the nominal motion, and what is seen of the residual then.
using Visit = std::function<void(bool nominal, const ResidualMemory& memory)>;

/// Follows an estimator's residual through a recording as `WhitenedDetector` does.
void follow(const ResidualRecording& of, const std::string& estimator, const Visit& visit) {
  const Recording& recording = *of.recording;
  const std::vector<bool> nominal = nominal_samples(recording, of.space);
  const auto signals = estimates_of(recording);
  const auto signal =
      std::find_if(signals.begin(), signals.end(), [&](const auto& each) { return each.first == estimator; });
  const auto estimates = read<WrenchEstimate>(recording, signal->second);
  const auto loads = read<DriveLoad>(recording, loads_of(recording));
  const ResidualTracking tracking = of.tracking.at(estimator);
  LoadHistory past;
  ResidualMemory memory, next;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const DriveLoad load = loads[k];
    follow_residual(estimates[k], load, past, Time(recording.time_ns[k]), tracking, memory, next);
    if (load.valid) past.push(load);
    memory = next;
    visit(nominal[k], memory);
  }
}

/// A part of a residual: what is seen of it, where it means something.
struct Statistic {
  DriveResidual SeenResidual::*part;
  bool SeenResidual::*means_something;  ///< null: always
  bool has_whole_torque;                ///< is seen with nearly the torque itself

  const DriveResidual* of(bool nominal, const SeenResidual& seen) const {
    return nominal && seen.is_new && (means_something == nullptr || seen.*means_something) ? &(seen.*part)
                                                                                           : nullptr;
  }
};

constexpr Statistic level_statistic{&SeenResidual::level, nullptr, true};
constexpr Statistic change_statistic{&SeenResidual::change, &SeenResidual::settled, false};
constexpr Statistic smoothed_statistic{&SeenResidual::smoothed, &SeenResidual::smooth, true};

ResidualErrors fit(const std::vector<ResidualRecording>& recordings, const std::string& estimator,
                   const Statistic& statistic) {
  std::size_t ticks = 0;
  for (const ResidualRecording& each : recordings) ticks += each.recording->samples();
  const std::size_t stride = 1 + ticks / most_samples;
  std::vector<ErrorSample> samples;
  std::size_t k = 0;
  for (const ResidualRecording& each : recordings) {
    follow(each, estimator, [&](bool nominal, const ResidualMemory& memory) {
      const DriveResidual* const seen = statistic.of(nominal, memory.seen);
      if (seen == nullptr || k++ % stride != 0) return;
      for (int i = 0; i < seen->effort.size(); ++i) {
        ErrorSample& sample = samples.emplace_back();
        sample.squared = seen->effort[i] * seen->effort[i];
        sample.features = error_features(memory.seen.load, *seen, i);
        sample.known = rising_variance(*seen);
        if (statistic.has_whole_torque) sample.features[2] = 0.0;  // it would count twice
      }
    });
  }
  if (samples.empty()) throw SetupError(estimator + ": no valid estimate is recorded");
  return fit_error_sizes(samples);
}

/// Of the errors of a residual's change, which `OnsetRatio` follows as far as no sample is missing.
std::optional<ErrorCourse> fit_course(const std::vector<ResidualRecording>& recordings,
                                      const std::string& estimator, const ResidualErrors& errors) {
  ErrorCourseFit fit;
  for (const ResidualRecording& each : recordings) {
    const Sampling sampling = each.tracking.at(estimator).sampling;
    Time last{};
    fit.interrupt();
    follow(each, estimator, [&](bool nominal, const ResidualMemory& memory) {
      if (nominal && memory.started && !memory.seen.is_new) return;
      const DriveResidual* const seen = change_statistic.of(nominal, memory.seen);
      if (seen == nullptr) return fit.interrupt();
      const Time acquired = memory.seen.load.acquired;
      if (sampling.lost_between(std::exchange(last, acquired), acquired)) fit.interrupt();
      fit.add(whitened(memory.seen.load, *seen, errors));
    });
  }
  return fit.course();
}

/// How surprising a residual is at a tick; none where there is nothing to judge.
using Surprise = std::function<std::optional<double>(bool nominal, const ResidualMemory& memory)>;

/// How surprising motion without contact is.
struct Surprises {
  std::vector<double> largest;  ///< of each stretch
  SurpriseTail tail;
};

/// Ticks without a surprise, as where the IMU is left out, are no part of a stretch.
Surprises surprises(const std::vector<ResidualRecording>& recordings, const std::string& estimator,
                    const Surprise& surprise_at, const ThresholdGoal& goal) {
  Surprises found;
  for (const ResidualRecording& each : recordings) {
    const auto length =
        static_cast<std::size_t>(std::max<std::int64_t>(1, goal.stretch / each.recording->period));
    if (!goal.one_robot) found.tail.begin_robot();
    std::size_t ticks = 0;  // of the present stretch
    double largest = 0.0;
    follow(each, estimator, [&](bool nominal, const ResidualMemory& memory) {
      const bool waits = nominal && memory.started && !memory.seen.is_new;
      const std::optional<double> seen = surprise_at(nominal, memory);
      if (!seen && !waits) return;
      if (ticks == 0) largest = 0.0;
      if (seen) {
        largest = std::max(largest, *seen);
        found.tail.add(*seen, static_cast<int>(memory.seen.load.torque.size()));
      }
      if (++ticks < length) return;
      found.largest.push_back(largest);
      ticks = 0;
    });
  }
  return found;
}

Surprise surprise_of(const Statistic& statistic, const ResidualErrors& errors) {
  return [=](bool nominal, const ResidualMemory& memory) -> std::optional<double> {
    const DriveResidual* const seen = statistic.of(nominal, memory.seen);
    if (seen == nullptr) return std::nullopt;
    return surprise(memory.seen.load, *seen, errors);
  };
}

/// Of onsets, as `WhitenedDetector` follows them.
Surprise surprise_of(const OnsetRatio& ratio) {
  return [=, onsets = OnsetMemory()](bool nominal,
                                     const ResidualMemory& memory) mutable -> std::optional<double> {
    OnsetMemory next;
    ratio.follow(memory.seen, onsets, next);
    onsets = next;
    if (change_statistic.of(nominal, memory.seen) == nullptr) return std::nullopt;
    return ratio.surprise(onsets);
  };
}

}  // namespace

std::vector<std::string> calibrated_residuals(const std::vector<ResidualRecording>& recordings,
                                              const std::vector<std::string>& wanted) {
  std::map<std::string, std::size_t> times;
  for (const ResidualRecording& each : recordings) {
    if (loads_of(*each.recording).empty()) return {};
    for (const auto& [estimator, signal] : estimates_of(*each.recording)) ++times[estimator];
  }
  std::vector<std::string> found;
  for (const std::string& name : wanted) {
    if (times[name] == recordings.size()) found.push_back(name);
  }
  return found;
}

std::vector<CalibratedResidual> calibrate_residuals(const std::vector<ResidualRecording>& recordings,
                                                    const std::vector<std::string>& estimators,
                                                    const ThresholdGoal& goal) {
  constexpr double parts = 3.0;  // level, change and smoothed
  const double share = 1.0 / (parts * static_cast<double>(estimators.size()));
  const double probability = share * goal.false_alarms_per_hour / 3600.0 * to_seconds(goal.stretch);
  std::vector<CalibratedResidual> all;
  for (const std::string& estimator : estimators) {
    CalibratedResidual& residual = all.emplace_back();
    residual.estimator = estimator;
    const auto told = [&](const Surprise& surprise_at) {
      Surprises found = surprises(recordings, estimator, surprise_at, goal);
      require_enough(estimator, found.largest.size(), goal);
      residual.stretches = found.largest.size();
      return found;
    };
    const auto calibrate_part = [&](const Statistic& statistic, CalibratedSurprise& part) {
      part.errors = fit(recordings, estimator, statistic);
      const Surprises found = told(surprise_of(statistic, part.errors));
      part.variation = found.tail.variation();
      part.between_robots = found.tail.between_robots();
      part.threshold =
          calibrated_threshold(found.largest, probability, goal, found.tail.power(goal.confidence));
    };
    calibrate_part(level_statistic, residual.level);
    calibrate_part(change_statistic, residual.change);
    calibrate_part(smoothed_statistic, residual.smoothed);
    if (const auto course = fit_course(recordings, estimator, residual.change.errors)) {
      residual.onset.emplace().course = *course;
      const OnsetRatio ratio(residual.change.errors, *course, recordings.front().tracking.at(estimator));
      residual.onset->threshold = calibrated_threshold(told(surprise_of(ratio)).largest, probability, goal);
    }
  }
  return all;
}

}  // namespace flinch
