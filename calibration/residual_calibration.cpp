#include "calibration/residual_calibration.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "calibration/autoregressive_error.h"
#include "calibration/contact_free_motion.h"
#include "calibration/error_sizes.h"
#include "calibration/mahalanobis_tail.h"
#include "diagrams/fused_detector.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"

namespace flinch {
namespace {

constexpr std::array judged{"disturbance_filter", "imu_residual"};
constexpr std::size_t most_samples = 60'000;  // of a drive, to which sizes are fitted
constexpr double still_hidden = 0.01;         // share of friction near rest that is left behind filters
constexpr double least_distance = 1e-6;       // that a threshold may have

/// The signal of the loads of the drives; "" where there is none.
std::string loads_of(const Recording& recording) {
  for (const Signal& signal : recording.signals) {
    if (signal.path.starts_with("load_")) return signal.path;
  }
  return "";
}

/// A recording that is followed once and again.
struct Motion {
  const ResidualRecording& of;
  const std::function<void()>& followed;
};

/// Whether the sample belongs to the nominal motion, and what is seen of the residual then.
using Visit = std::function<void(bool nominal, const ResidualMemory& memory)>;

/// Follows an estimator's residual through a recording as `WhitenedDetector` does.
void follow(const Motion& motion, const std::string& estimator, const Visit& visit) {
  const Recording& recording = *motion.of.recording;
  const auto signals = estimates_of(recording);
  const auto signal =
      std::find_if(signals.begin(), signals.end(), [&](const auto& each) { return each.first == estimator; });
  const auto estimates = read<WrenchEstimate>(recording, signal->second);
  const auto loads = read<DriveLoad>(recording, loads_of(recording));
  const ResidualTracking tracking = motion.of.tracking.at(estimator);
  LoadHistory past;
  ResidualMemory memory, next;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const DriveLoad load = loads[k];
    track_residual(estimates[k], load, past, Time(recording.time_ns[k]), tracking, memory, next);
    if (load.valid) past.push(load);
    memory = next;
    visit(motion.of.nominal[k], memory);
  }
  motion.followed();
}

/// A part of a residual: what is seen of it, where it means something.
struct Statistic {
  DriveResidual ResidualSample::*part;
  bool ResidualSample::*means_something;  ///< null: always
  bool has_whole_torque;                  ///< is seen with nearly the torque itself

  const DriveResidual* of(bool nominal, const ResidualSample& seen) const {
    return nominal && seen.is_new && (means_something == nullptr || seen.*means_something) ? &(seen.*part)
                                                                                           : nullptr;
  }
};

constexpr Statistic level_statistic{&ResidualSample::level, nullptr, true};
constexpr Statistic change_statistic{&ResidualSample::change, &ResidualSample::settled, false};
constexpr Statistic smoothed_statistic{&ResidualSample::smoothed, &ResidualSample::smooth, true};
constexpr std::array statistics{level_statistic, change_statistic, smoothed_statistic};

/// Which drives slide, so that no dry friction near rest hides their errors.
class SlidingDrives {
 public:
  void see(const JointVector& hidden) {
    if (widest_.size() != hidden.size()) widest_.setZero(hidden.size());
    widest_ = widest_.cwiseMax(hidden);
    hidden_ = hidden;
  }
  bool slides(int drive) const { return hidden_[drive] <= still_hidden * widest_[drive]; }
  bool all() const { return (hidden_.array() <= still_hidden * widest_.array()).all(); }

 private:
  JointVector widest_;  ///< Range in which friction may hide an error, at most so far [Nm or N].
  JointVector hidden_;  ///< The same, now.
};

/// Every `stride`-th error of a statistic, of drives that slide.
class ErrorSamples {
 public:
  ErrorSamples(const Statistic& statistic, std::size_t stride) : statistic_(statistic), stride_(stride) {}

  void add(bool nominal, const ResidualSample& all) {
    const DriveResidual* const seen = statistic_.of(nominal, all);
    if (seen == nullptr || ticks_++ % stride_ != 0) return;
    drives_.see(all.hidden);
    for (int i = 0; i < seen->effort.size(); ++i) {
      if (!drives_.slides(i)) continue;
      ErrorSample& sample = samples_.emplace_back();
      sample.squared = seen->effort[i] * seen->effort[i];
      sample.features = error_features(all.load, *seen, i);
      sample.known = rising_variance(*seen);
      if (statistic_.has_whole_torque) sample.features[2] = 0.0;  // it would count twice
    }
  }
  const std::vector<ErrorSample>& all() const { return samples_; }

 private:
  Statistic statistic_;
  std::size_t stride_;
  std::size_t ticks_ = 0;
  SlidingDrives drives_;
  std::vector<ErrorSample> samples_;
};

/// Of each statistic.
std::vector<ResidualErrors> fit(const std::vector<Motion>& motions, const std::string& estimator) {
  std::size_t ticks = 0;
  for (const Motion& each : motions) ticks += each.of.nominal.size();
  const std::size_t stride = 1 + ticks / most_samples;
  std::vector<ErrorSamples> samples;
  for (const Statistic& statistic : statistics) samples.emplace_back(statistic, stride);
  for (const Motion& each : motions) {
    follow(each, estimator, [&samples](bool nominal, const ResidualMemory& memory) {
      for (ErrorSamples& of : samples) of.add(nominal, memory.seen);
    });
  }
  std::vector<ResidualErrors> errors;
  for (const ErrorSamples& of : samples) {
    if (of.all().empty()) throw SetupError(estimator + ": no valid estimate is recorded of drives that move");
    errors.push_back(fit_error_sizes(of.all()));
  }
  return errors;
}

/// Of the errors of a residual's change, which `OnsetRatio` follows as far as no sample is missing.
std::optional<AutoregressiveError> fit_course(const std::vector<Motion>& motions,
                                              const std::string& estimator, const ResidualErrors& errors) {
  AutoregressiveErrorFit fit;
  for (const Motion& each : motions) {
    const Sampling sampling = each.of.tracking.at(estimator).sampling;
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

/// The Mahalanobis distance of a residual at a tick; none where there is nothing to judge.
using Distance = std::function<std::optional<double>(bool nominal, const ResidualMemory& memory)>;

/// Mahalanobis distances of motion without contact. Ticks without one, as where the IMU is left out, are no
/// part of a stretch.
class Distances {
 public:
  Distances(Distance distance, const ThresholdGoal& goal) : distance_(std::move(distance)), goal_(goal) {}

  void begin(const Recording& recording) {
    length_ = static_cast<std::size_t>(std::max<std::int64_t>(1, goal_.stretch / recording.period));
    if (!goal_.one_robot) tail_.begin_robot();
    ticks_ = 0;
  }
  void add(bool nominal, const ResidualMemory& memory) {
    const bool waits = nominal && memory.started && !memory.seen.is_new;
    const std::optional<double> seen = distance_(nominal, memory);
    if (!seen && !waits) return;
    if (ticks_ == 0) largest_now_ = 0.0;
    if (seen) {
      largest_now_ = std::max(largest_now_, *seen);
      drives_.see(memory.seen.hidden);
      if (drives_.all()) tail_.add(*seen, static_cast<int>(memory.seen.load.torque.size()));
    }
    if (++ticks_ < length_) return;
    largest_.push_back(largest_now_);
    ticks_ = 0;
  }

  const std::vector<double>& largest() const { return largest_; }  ///< of each stretch
  const MahalanobisTail& tail() const { return tail_; }

 private:
  Distance distance_;
  ThresholdGoal goal_;
  std::size_t length_ = 1;
  std::size_t ticks_ = 0;  // of the present stretch
  double largest_now_ = 0.0;
  SlidingDrives drives_;
  std::vector<double> largest_;
  MahalanobisTail tail_;
};

/// Of each of `which`. Throws SetupError where there is too little motion.
std::vector<Distances> distances(const std::vector<Motion>& motions, const std::string& estimator,
                                 const std::vector<Distance>& which, const ThresholdGoal& goal) {
  std::vector<Distances> all;
  for (const Distance& distance : which) all.emplace_back(distance, goal);
  for (const Motion& each : motions) {
    for (Distances& of : all) of.begin(*each.of.recording);
    follow(each, estimator, [&all](bool nominal, const ResidualMemory& memory) {
      for (Distances& of : all) of.add(nominal, memory);
    });
  }
  for (const Distances& of : all) require_enough(estimator, of.largest().size(), goal);
  return all;
}

Distance distance_of(const Statistic& statistic, const ResidualErrors& errors) {
  return [=](bool nominal, const ResidualMemory& memory) -> std::optional<double> {
    const DriveResidual* const seen = statistic.of(nominal, memory.seen);
    if (seen == nullptr) return std::nullopt;
    return mahalanobis_distance(memory.seen.load, *seen, errors);
  };
}

/// Of onsets, as `WhitenedDetector` follows them.
Distance distance_of(const OnsetRatio& ratio) {
  return [=, onsets = OnsetMemory()](bool nominal,
                                     const ResidualMemory& memory) mutable -> std::optional<double> {
    OnsetMemory next;
    ratio.follow(memory.seen, onsets, next);
    onsets = next;
    if (change_statistic.of(nominal, memory.seen) == nullptr) return std::nullopt;
    return ratio.mahalanobis_distance(onsets);
  };
}

/// Those that a fused detector judges by and all recordings have an estimate of.
std::vector<std::string> judged_estimators(const std::vector<ResidualRecording>& recordings) {
  std::map<std::string, std::size_t> times;
  for (const ResidualRecording& each : recordings) {
    if (loads_of(*each.recording).empty()) return {};
    for (const auto& [estimator, signal] : estimates_of(*each.recording)) ++times[estimator];
  }
  std::vector<std::string> found;
  for (const char* const name : judged) {
    if (times[name] == recordings.size()) found.emplace_back(name);
  }
  return found;
}

}  // namespace

ResidualRecording::ResidualRecording(const Recording& of, std::vector<bool> samples,
                                     const ContactControlSettings& settings)
    : recording(&of), nominal(std::move(samples)) {
  for (const char* const name : judged) tracking[name] = tracking_of(name, settings);
}

std::vector<CalibratedResidual> calibrate_residuals(const std::vector<ResidualRecording>& recordings,
                                                    const ThresholdGoal& goal,
                                                    const std::function<void(double)>& progress) {
  const std::vector<std::string> estimators = judged_estimators(recordings);
  if (estimators.empty()) return {};
  const auto parts = static_cast<double>(statistics.size());
  const double share = 1.0 / (parts * static_cast<double>(estimators.size()));
  const double probability = share * goal.false_alarms_per_hour / 3600.0 * to_seconds(goal.stretch);
  const std::size_t passes = 4 * estimators.size();
  std::size_t done = 0;
  const std::function<void()> followed = [&] {
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(passes * recordings.size()));
  };
  std::vector<Motion> motions;
  for (const ResidualRecording& each : recordings) motions.push_back({each, followed});
  std::vector<CalibratedResidual> all;
  for (const std::string& estimator : estimators) {
    CalibratedResidual& residual = all.emplace_back();
    residual.estimator = estimator;
    const std::vector<ResidualErrors> errors = fit(motions, estimator);
    std::vector<Distance> of_statistics;
    for (std::size_t i = 0; i < statistics.size(); ++i)
      of_statistics.push_back(distance_of(statistics[i], errors[i]));
    const std::vector<Distances> found = distances(motions, estimator, of_statistics, goal);
    const std::array parts_of{&residual.level, &residual.change, &residual.smoothed};
    for (std::size_t i = 0; i < statistics.size(); ++i) {
      const MahalanobisTail& tail = found[i].tail();
      *parts_of[i] = {
          errors[i], tail.variation(), tail.between_robots(),
          calibrated_threshold(found[i].largest(), probability, goal, tail.power(goal.confidence))};
      require_errors(estimator + ", residual in deviations", parts_of[i]->threshold, least_distance);
    }
    residual.stretches = found.back().largest().size();
    if (const auto course = fit_course(motions, estimator, residual.change.errors)) {
      const OnsetRatio ratio(residual.change.errors, *course, recordings.front().tracking.at(estimator));
      const Distances onsets = distances(motions, estimator, {distance_of(ratio)}, goal).front();
      residual.stretches = onsets.largest().size();
      residual.onset = {*course, calibrated_threshold(onsets.largest(), probability, goal)};
      require_errors(estimator + ", onset in deviations", residual.onset->threshold, least_distance);
    }
  }
  return all;
}

std::vector<CalibratedResidual> calibrate_residuals(const std::vector<ResidualRecording>& recordings,
                                                    const ThresholdGoal& goal,
                                                    std::vector<std::string>& left_out,
                                                    const std::function<void(double)>& progress) {
  try {
    return calibrate_residuals(recordings, goal, progress);
  } catch (const SetupError& error) {
    for (const std::string& problem : error.problems())
      left_out.push_back("the fused detector has no thresholds: " + problem);
    return {};
  }
}

}  // namespace flinch
