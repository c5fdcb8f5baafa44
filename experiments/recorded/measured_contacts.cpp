#include "experiments/recorded/measured_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "systems/foundation/median.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/force_torque_reading.h"

namespace flinch {
namespace {

constexpr double quiet = 0.1;             ///< Time below the threshold after which a contact has ended [s].
constexpr double quiet_deviations = 4.0;  ///< Noise of three components together is this large once in 1000.
constexpr double least_deviations = 6.0;
constexpr double rounding = 1e-9;  ///< Error of a time in seconds [s].

/// A valid sample of the force sensor.
struct ForceSample {
  double at = 0.0;  ///< [s]
  Eigen::Vector3d force{0.0, 0.0, 0.0};
};

std::vector<ForceSample> samples_of(const Recording& readings) {
  if (readings.find("force_torque") == nullptr) {
    throw SetupError(
        "--truth force: the log has no force sensor; map its columns to force_torque.force and "
        "force_torque.moment, or mark contacts by --contact and --free");
  }
  std::vector<ForceSample> samples;
  const auto all = read<ForceTorqueReading>(readings, "force_torque");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const ForceTorqueReading reading = all[k];
    if (reading.valid)
      samples.push_back({1e-9 * static_cast<double>(readings.time_ns[k]), reading.force_in_base});
  }
  if (samples.empty())
    throw SetupError(
        "--truth force: no sample of the force sensor is valid; see what `flinch import` says of it");
  return samples;
}

bool lies_in(double at, const std::vector<LogTruth::Stretch>& stretches) {
  return std::any_of(stretches.begin(), stretches.end(),
                     [at](const LogTruth::Stretch& each) { return each.contains(at); });
}

/// What the sensor shows while nothing touches.
struct SensorAtRest {
  Eigen::Vector3d zero{0.0, 0.0, 0.0};  ///< [N]
  double deviation = 0.0;               ///< Largest of the components [N].
};

SensorAtRest at_rest(const std::vector<ForceSample>& samples, const std::vector<LogTruth::Stretch>& free) {
  SensorAtRest rest;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const ForceSample& sample : samples) {
      if (free.empty() || lies_in(sample.at, free)) values.push_back(sample.force[axis]);
    }
    if (values.empty())
      throw SetupError("--truth force: the force sensor has no valid sample in what --free marks");
    rest.zero[axis] = median(values);
    for (double& value : values) value = std::abs(value - rest.zero[axis]);
    constexpr double deviations_per_median = 1.4826;  // of normal noise
    rest.deviation = std::max(rest.deviation, deviations_per_median * median(values));
  }
  return rest;
}

/// Contacts, sample by sample.
class ContactIntervals {
 public:
  ContactIntervals(const SensorAtRest& rest, double threshold) : rest_(rest), threshold_(threshold) {}

  void see(const ForceSample& sample) {
    const double force = (sample.force - rest_.zero).norm();
    const bool was_touched = is_touched_;
    if (is_touched_) {
      if (force >= 0.5 * threshold_) pressed_ = sample.at;
      found_.back().to = sample.at;
      is_touched_ = sample.at - pressed_ < quiet - rounding;
    } else if (force > threshold_) {
      found_.push_back({quiet_at_.value_or(sample.at), sample.at});
      begins_touched_ = begins_touched_ || !quiet_at_;
      is_touched_ = true;
      pressed_ = sample.at;
    }
    const bool is_within_noise = force <= quiet_deviations * rest_.deviation;
    if (!is_touched_ && (is_within_noise || was_touched || !quiet_at_)) quiet_at_ = sample.at;
  }

  /// Contacts, the last one open where the log ends in it.
  const std::vector<LogTruth::Stretch>& found() const { return found_; }
  /// Whether the first one lasts since the first sample.
  bool begins_touched() const { return begins_touched_; }

 private:
  SensorAtRest rest_;
  double threshold_;
  bool is_touched_ = false;
  bool begins_touched_ = false;
  double pressed_ = 0.0;
  std::optional<double> quiet_at_;
  std::vector<LogTruth::Stretch> found_;
};

void require_above_noise(double threshold, double deviation) {
  if (std::isfinite(threshold) && threshold > 0.0 && threshold >= least_deviations * deviation) return;
  throw SetupError(fmt::format(
      "--contact-force: is {:g} N; it must be at least {:.2g} N, six deviations of what the force sensor "
      "shows without contact, and above 0",
      threshold, least_deviations * deviation));
}

/// What the sensor tells and is in no contact.
std::vector<LogTruth::Stretch> free_of(const std::vector<ForceSample>& samples,
                                       const std::vector<LogTruth::Stretch>& contacts) {
  std::vector<LogTruth::Stretch> free;
  bool goes_on = false;
  double last = samples.front().at;
  auto contact = contacts.begin();
  for (const ForceSample& sample : samples) {
    while (contact != contacts.end() && contact->to < sample.at) ++contact;
    const bool is_touched = contact != contacts.end() && contact->from < sample.at;
    goes_on = goes_on && !is_touched && sample.at - last < quiet;
    last = sample.at;
    if (is_touched) continue;
    if (!goes_on) free.push_back({sample.at, sample.at});
    free.back().to = sample.at;
    goes_on = true;
  }
  std::erase_if(free, [](const LogTruth::Stretch& each) { return each.from >= each.to; });
  return free;
}

}  // namespace

LogTruth measured_contacts(const Recording& readings, std::optional<double> threshold,
                           const std::vector<LogTruth::Stretch>& free) {
  const std::vector<ForceSample> samples = samples_of(readings);
  const SensorAtRest rest = at_rest(samples, free);
  const double above = threshold.value_or(std::max(least_contact_force, least_deviations * rest.deviation));
  require_above_noise(above, rest.deviation);
  ContactIntervals intervals(rest, above);
  for (const ForceSample& sample : samples) {
    intervals.see(sample);
    if ((sample.force - rest.zero).norm() > above && lies_in(sample.at, free)) {
      throw SetupError(
          fmt::format("--free: the force sensor shows {:.1f} N at {:.3f} s, which is said to be free",
                      (sample.force - rest.zero).norm(), sample.at));
    }
  }
  if (intervals.begins_touched() && free.empty()) {
    throw SetupError(
        "--truth force: the force differs at the begin of the log from what it mostly is; say by --free A..B "
        "where nothing touches, so that the zero of the sensor is known");
  }
  LogTruth truth;
  truth.source = "measured by the force sensor";
  truth.measured = intervals.found();
  truth.free = free_of(samples, truth.measured);
  for (const LogTruth::Stretch& each : truth.measured) truth.contacts.push_back(each.from);
  if (intervals.begins_touched()) truth.contacts.erase(truth.contacts.begin());
  return truth;
}

}  // namespace flinch
