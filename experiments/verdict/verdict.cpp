#include "experiments/verdict/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "experiments/verdict/contact_watch.h"
#include "experiments/verdict/recorded_run.h"
#include "systems/framework/recording.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reaction_state.h"

namespace flinch {
namespace {

/// Whether something touches the robot, as far as the witness knows: an obstacle or an applied wrench.
bool is_touched(const RunSample& now, Witness witness) {
  if (witness == Witness::none) return now.detection.level != ContactLevel::none;
  return now.is_touched();
}

/// Collects when the detector rose, and which of these times were false.
class DetectionWatch {
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

void note_first(const RunSample& now, Verdict& verdict) {
  for (std::size_t i = 0; i < verdict.first_noticed.size() && i < now.noticed_by.size(); ++i) {
    std::optional<double>& first = verdict.first_noticed[i].detected;
    if (now.noticed_by[i] && !first) first = now.time;
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

std::string description_of(GateFault fault) {
  for (const FaultRow& row : fault_table()) {
    if (row.fault == fault) return row.description;
  }
  return "the run was too short";
}

/// Counts what was lost within a few milliseconds: what the gate notices after that has other causes.
class LossWatch {
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
class FaultWatch {
 public:
  void see(const RunSample& now, Verdict& verdict) {
    ticks_.see(now.time, now.lost_ticks);
    readings_.see(now.time, now.unread_readings - unread_.value_or(now.unread_readings));
    unread_ = now.unread_readings;
    if (verdict.fault.empty() && now.gate.fault != GateFault::none) {
      verdict.fault = description_of(now.gate.fault) + cause(now);
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
    return fmt::format("; {} of the joints {} lost just before",
                       readings == 1 ? "a reading" : fmt::format("{} readings", readings),
                       readings == 1 ? "was" : "were");
  }

  LossWatch ticks_, readings_;
  std::optional<int> unread_;
};

void expect_contact(const Verdict& verdict, const Expectations& expected,
                    std::vector<std::string>& failures) {
  if (!expected.contact) return;
  if (*expected.contact == "none") {
    const bool is_touched = std::any_of(verdict.contacts.begin(), verdict.contacts.end(),
                                        [](const ContactVerdict& contact) { return !contact.is_push; });
    if (is_touched) failures.push_back("there was a contact, though none was expected");
    return;
  }
  if (verdict.witness == Witness::none) return;
  if (verdict.contacts.empty()) {
    failures.push_back("nothing was touched, though a contact with " + *expected.contact + " was expected");
  } else if (!verdict.contacts.front().body.empty() && verdict.contacts.front().body != *expected.contact) {
    failures.push_back(verdict.contacts.front().body + " was touched instead of " + *expected.contact);
  }
}

std::string name_of(const ContactVerdict& contact) {
  return contact.body.empty() ? "the pylon" : contact.body;
}

void judge_contacts(const Verdict& verdict, const Expectations& expected,
                    std::vector<std::string>& failures) {
  for (const ContactVerdict& contact : verdict.contacts) {
    const std::string touched = name_of(contact);
    const bool is_load = contact.is_push && expected.contact == "none";
    if (!contact.detected) {
      if (is_load) continue;
      failures.push_back("the contact with " + touched + " was not detected");
    } else if (expected.detection_time && *contact.detected - contact.onset > *expected.detection_time) {
      failures.push_back(fmt::format("the contact with {} was detected after {:.1f} ms, later than {:.1f} ms",
                                     touched, 1e3 * (*contact.detected - contact.onset),
                                     1e3 * *expected.detection_time));
    }
    if (!contact.within_limit) {
      const bool lasts = contact.limit_name == "quasi-static";
      failures.push_back(fmt::format("the force on {} {} {:.0f} N, above the {} limit of {:.0f} N", touched,
                                     lasts ? "stayed at" : "reached",
                                     lasts ? *contact.lasting_force : contact.peak_force, contact.limit_name,
                                     contact.limit));
    }
  }
}

void remark_contacts(const Verdict& verdict, std::vector<std::string>& remarks) {
  for (const ContactVerdict& contact : verdict.contacts) {
    if (!contact.removed)
      remarks.push_back("the contact with " + name_of(contact) + " was not over at the end");
  }
}

void expect_at_most(const char* what, double value, std::optional<double> bound, const char* unit,
                    double scale, std::vector<std::string>& failures) {
  if (!bound || value <= *bound) return;
  failures.push_back(fmt::format("the {} reached {:.4g} {}, above {:.4g} {}", what, scale * value, unit,
                                 scale * *bound, unit));
}

/// Measures all that a run shows, in one pass over its samples.
Verdict measure(const Recording& recording, const ConfigurationSpace& space, const ForceLimits& limits,
                std::vector<std::string>& failures) {
  const RecordedRun run(recording, space);
  Verdict verdict;
  verdict.witness = run.witness();
  for (const std::string& estimator : run.estimators())
    verdict.first_noticed.push_back({estimator, std::nullopt});
  ContactWatch contacts(limits, run.estimators());
  DetectionWatch detections;
  FaultWatch faults;
  bool was_touched = false, gate_opens = false;
  GateStatus gate;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const RunSample now = run[k];
    const bool touched = is_touched(now, verdict.witness);
    contacts.see(now, run.period());
    detections.see(now, touched, verdict);
    note_first(now, verdict);
    was_touched |= touched;
    if (!was_touched) measure_errors(now, verdict);
    if (now.is_true) verdict.loop_closure = std::max(verdict.loop_closure.value_or(0.0), now.loop_closure);
    gate = now.gate;
    gate_opens |= gate.phase == GatePhase::open;
    faults.see(now, verdict);
  }
  verdict.contacts = contacts.contacts();
  if (run.size() == 0) return verdict;
  verdict.simulated = run.duration();
  if (!gate_opens) {
    failures.push_back("the torque gate never opened: " + description_of(first_fault(gate.faults)));
  }
  return verdict;
}

}  // namespace

Verdict judge(const Recording& recording, const ConfigurationSpace& space, const Expectations& expected,
              const ForceLimits& limits) {
  std::vector<std::string> of_the_gate;
  Verdict verdict = measure(recording, space, limits, of_the_gate);
  expect_contact(verdict, expected, verdict.failures);
  judge_contacts(verdict, expected, verdict.failures);
  remark_contacts(verdict, verdict.remarks);
  const auto partial = recording.attributes.find("recording.partial");
  if (partial != recording.attributes.end()) verdict.remarks.push_back(partial->second);
  verdict.failures.insert(verdict.failures.end(), of_the_gate.begin(), of_the_gate.end());
  if (verdict.false_detections > 0) verdict.failures.push_back("a contact was detected where there was none");
  if (!verdict.fault.empty()) verdict.failures.push_back("the torque gate closed: " + verdict.fault);
  expect_at_most("observer error", verdict.max_observer_error_force, expected.observer_error, "N", 1.0,
                 verdict.failures);
  expect_at_most("observer error", verdict.max_observer_error_moment, expected.observer_error_moment, "Nm",
                 1.0, verdict.failures);
  expect_at_most("tracking error", verdict.max_tracking_error, expected.tracking_error, "mm", 1e3,
                 verdict.failures);
  expect_at_most("loop closure error", verdict.loop_closure.value_or(0.0), expected.loop_closure, "m", 1.0,
                 verdict.failures);
  return verdict;
}

}  // namespace flinch
