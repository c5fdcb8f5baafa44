#include "experiments/verdict/run_monitor.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/verdict/check_words.h"
#include "experiments/verdict/contact_monitor.h"
#include "experiments/verdict/fault_words.h"
#include "experiments/verdict/return_monitor.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reaction_state.h"

namespace flinch {
namespace {

constexpr const char* no_fault = "the run was too short";

/// Whether something touches the robot, as far as the witness knows: an obstacle or an applied wrench.
bool is_touched(const RunSample& now, Witness witness) {
  if (witness == Witness::none) return now.detection.level != ContactLevel::none;
  return now.is_touched();
}

/// Collects when the detector rose, and which of these times were false.
class DetectionMonitor {
 public:
  void see(const RunSample& now, bool touched, Verdict& verdict) {
    const ContactLevel before = level_.value_or(now.detection.level);
    if (level_ && touched) last_touched_ = now.time;
    if (now.detection.level != ContactLevel::none && before == ContactLevel::none) {
      verdict.detections.push_back(now.time);
      if (now.time - last_touched_ >= Verdict::same_contact) ++verdict.false_detections;
    }
    level_ = now.detection.level;
  }

 private:
  std::optional<ContactLevel> level_;  ///< of the sample before
  double last_touched_ = -Verdict::same_contact;
};

void extend(double measure, std::optional<MeasureRange>& range) {
  if (std::isnan(measure)) return;
  if (!range) range = {measure, measure, measure, measure};
  *range = {range->first, std::min(range->least, measure), std::max(range->most, measure), measure};
}

void extend(const RunSample& now, MeasureRanges& ranges) {
  extend(now.sigma_kappa, ranges.sigma_kappa);
  extend(now.sigma_sc, ranges.sigma_sc);
}

void note_first(const RunSample& now, Verdict& verdict) {
  for (std::size_t i = 0; i < verdict.first_detected.size() && i < now.detected_by.size(); ++i) {
    std::optional<double>& first = verdict.first_detected[i].detected;
    if (now.detected_by[i] && !first) first = now.time;
  }
}

/// The largest errors, as long as nothing has touched the robot.
void measure_errors(const RunSample& now, Verdict& verdict) {
  const auto keep_largest = [](double error, double& largest) { largest = std::max(largest, error); };
  if (now.estimate_valid) {
    keep_largest(now.observer_error_force, verdict.max_observer_error_force);
    keep_largest(now.observer_error_moment, verdict.max_observer_error_moment);
  }
  if (now.mode != ReactionMode::nominal || !now.reference_valid) return;
  keep_largest(now.position_error, verdict.max_tracking_error);
  keep_largest(now.orientation_error, verdict.max_orientation_error);
}

void note_self_contact(const SelfContact& found, double time, Verdict& verdict) {
  const auto same = [&found](const SelfContact& seen) {
    return seen.body == found.body && seen.other == found.other;
  };
  std::vector<SelfContact>& all = verdict.self_contacts;
  if (std::none_of(all.begin(), all.end(), same)) all.push_back({found.body, found.other, time});
}

/// Counts what was lost within a few milliseconds: what the gate detects after that has other causes.
class LossMonitor {
 public:
  void see(double time, int lost) {
    if (lost <= 0) return;
    if (!is_recent(time)) count_ = 0;
    count_ += lost;
    last_ = time;
  }
  int recent(double time) const { return is_recent(time) ? count_ : 0; }

 private:
  static constexpr double window = 0.01;  // [s]
  bool is_recent(double time) const { return last_ && time - *last_ <= window; }

  int count_ = 0;
  std::optional<double> last_;  ///< [s]
};

/// Says why the gate closed: the fault, and what had been lost just before, where that explains it.
class FaultMonitor {
 public:
  void see(const RunSample& now, Verdict& verdict) {
    ticks_.see(now.time, now.lost_ticks);
    readings_.see(now.time, now.unread_readings - unread_.value_or(now.unread_readings));
    unread_ = now.unread_readings;
    if (verdict.fault.empty() && now.gate.fault != GateFault::none) {
      verdict.fault = description_of(now.gate.fault, no_fault) + cause(now);
    }
  }

 private:
  /// Ticks that were missed explain readings that nobody saw.
  std::string cause(const RunSample& now) const {
    if (now.gate.fault > GateFault::drives_stale) return "";  // not of what comes in
    const int ticks = ticks_.recent(now.time), readings = readings_.recent(now.time);
    if (ticks > 0)
      return fmt::format("; {} {} missed just before", ticks, ticks == 1 ? "tick was" : "ticks were");
    if (readings == 0) return "";
    return fmt::format("; {} of the joints came to no tick just before",
                       readings == 1 ? "a reading" : fmt::format("{} readings", readings));
  }

  LossMonitor ticks_, readings_;
  std::optional<int> unread_;
};

}  // namespace

struct RunMonitor::Parts {
  Parts(const RecordedRun& run, const ForceLimits& limits)
      : period(run.period()), contacts(limits, run.estimators(), run.obstacles()) {
    verdict.witness = run.witness();
    verdict.limits = limits;
    for (const std::string& estimator : run.estimators())
      verdict.first_detected.push_back({estimator, std::nullopt});
  }

  double period;  ///< [s]
  Verdict verdict;
  ContactMonitor contacts;
  DetectionMonitor detections;
  FaultMonitor faults;
  ReturnMonitor returns;
  std::optional<CheckMask> askable;  ///< at any sample
  bool drives_checked = false;
  bool was_touched = false, gate_opens = false;
  GateStatus gate;
  std::optional<double> first;  ///< sample [s]
  double last = 0.0;            ///< likewise
};

RunMonitor::RunMonitor(const RecordedRun& run, const ForceLimits& limits)
    : parts_(std::make_unique<Parts>(run, limits)) {}

RunMonitor::~RunMonitor() = default;

void RunMonitor::see(const RunSample& now) {
  Parts& so_far = *parts_;
  Verdict& verdict = so_far.verdict;
  const bool touched = is_touched(now, verdict.witness);
  so_far.contacts.see(now, so_far.period);
  so_far.detections.see(now, touched, verdict);
  note_first(now, verdict);
  so_far.was_touched |= touched;
  if (!so_far.was_touched) measure_errors(now, verdict);
  if (now.is_true) verdict.loop_closure = std::max(verdict.loop_closure.value_or(0.0), now.loop_closure);
  if (now.self_contact) note_self_contact(*now.self_contact, now.time, verdict);
  if (!std::isnan(now.drive_torque))
    verdict.largest_torque = std::max(verdict.largest_torque.value_or(0.0), now.drive_torque);
  extend(now, verdict.measures);
  if (!verdict.detections.empty()) extend(now, verdict.measures_once_detected);
  so_far.gate = now.gate;
  so_far.gate_opens |= now.gate.phase == GatePhase::open;
  so_far.faults.see(now, verdict);
  so_far.returns.see(now);
  if (verdict.imu_doubt == ImuFault::none && now.doubts.imu != ImuFault::none) {
    verdict.imu_doubt = now.doubts.imu;
    verdict.imu_doubted = now.time;
  }
  if (now.askable) so_far.askable = so_far.askable.value_or(0) | *now.askable;
  if (now.drive_check) {
    so_far.drives_checked = true;
    verdict.drive_check = *now.drive_check;
  }
  if (!verdict.passive_lost && now.doubts.passive_lost) verdict.passive_lost = now.time;
  if (!so_far.first) so_far.first = now.time;
  so_far.last = now.time;
}

Verdict RunMonitor::seen() const {
  Verdict verdict = parts_->verdict;
  verdict.contacts = parts_->contacts.contacts();
  verdict.returned = parts_->returns.seen();
  if (parts_->askable) verdict.checks_off = checks_off(*parts_->askable, parts_->drives_checked);
  if (!parts_->first) return verdict;
  verdict.simulated = parts_->last - *parts_->first + parts_->period;
  if (!parts_->gate_opens) {
    verdict.failures.push_back("the torque gate never opened: " +
                               description_of(first_fault(parts_->gate.faults), no_fault));
  }
  return verdict;
}

}  // namespace flinch
