#include "experiments/verdict/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "experiments/verdict/recorded_run.h"
#include "systems/framework/recording.h"
#include "systems/robot/body_id.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reaction_state.h"

namespace flinch {
namespace {

/// Finds the contacts, sample by sample.
class ContactWatch {
 public:
  explicit ContactWatch(const ForceLimits& limits) : limits_(limits) {}

  void see(const RunSample& now, double period) {
    const bool touches = now.force() > Verdict::contact_force;
    if (touches && !(is_open_ && now.time - last_ < Verdict::same_contact)) begin(now);
    if (is_open_) {
      pending_.see(now);
      if (touches) extend(now, period);
      // The latched level would not do: of a second contact it knows nothing.
      const bool noticed = now.detection.present_level != ContactLevel::none;
      if (noticed && !contacts_.back().detected && now.time < last_ + Verdict::same_contact) {
        contacts_.back().detected = now.time;
      }
    }
    before_ = now;
  }

  /// All contacts of a run that ended with the sample seen last.
  std::vector<ContactVerdict> contacts() const {
    std::vector<ContactVerdict> judged = contacts_;
    if (is_open_ && before_->time - last_ < Verdict::same_contact) judged.back().removed.reset();
    for (ContactVerdict& contact : judged) limit_force(contact);
    return judged;
  }

 private:
  /// What was seen since the last sample with force, which counts if there comes another.
  struct Pending {
    double speed = 0.0;
    std::string clamping;

    void see(const RunSample& sample) {
      speed = std::max(speed, sample.speed());
      if (clamping.empty() && sample.clamping) {
        clamping = "leg" + std::to_string(BodyId::from_index(sample.body).leg() + 1) + "_clamping";
      }
    }
  };

  void begin(const RunSample& now) {
    ContactVerdict contact;
    contact.onset = onset_at(now);
    contact.peak_force = -1.0;
    contacts_.push_back(contact);
    pending_ = {before_ ? std::max(0.0, before_->speed()) : 0.0, ""};
    clamps_ = false;
    is_open_ = true;
  }

  /// When the force rose above `contact_force`, between the sample before and this one.
  double onset_at(const RunSample& now) const {
    if (!before_ || std::isnan(before_->force())) return now.time;
    const double share = (Verdict::contact_force - before_->force()) / (now.force() - before_->force());
    return before_->time + share * (now.time - before_->time);
  }

  void extend(const RunSample& now, double period) {
    ContactVerdict& contact = contacts_.back();
    last_ = now.time;
    contact.removed = now.time + period;
    contact.speed = std::max(contact.speed, pending_.speed);
    if (now.time - contact.onset > limits_.transient_duration) {
      contact.lasting_force = std::max(contact.lasting_force.value_or(0.0), now.force());
    }
    name_body(now, contact);
    if (now.force() > contact.peak_force) {
      contact.peak_force = now.force();
      contact.peak_time = now.time;
    }
    pending_ = {};
  }

  /// A leg's clamping where that happens during the contact, else the body with the peak force.
  void name_body(const RunSample& now, ContactVerdict& contact) {
    if (!now.is_true || clamps_) return;
    clamps_ = !pending_.clamping.empty();
    if (clamps_) {
      contact.body = pending_.clamping;
    } else if (now.force() > contact.peak_force) {
      contact.body = body_name(BodyId::from_index(now.body));
    }
  }

  /// The peak counts against the transient limit, what lasts longer against the quasi-static one.
  void limit_force(ContactVerdict& contact) const {
    const bool peak_is_good = contact.peak_force <= limits_.transient;
    const bool rest_is_good = contact.lasting_force.value_or(0.0) <= limits_.quasi_static;
    contact.within_limit = peak_is_good && rest_is_good;
    contact.limit = peak_is_good && !rest_is_good ? limits_.quasi_static : limits_.transient;
    contact.limit_name = peak_is_good && !rest_is_good ? "quasi-static" : "transient";
  }

  ForceLimits limits_;
  std::vector<ContactVerdict> contacts_;
  bool is_open_ = false;  ///< there was one
  double last_ = 0.0;     ///< sample with force [s]
  bool clamps_ = false;
  Pending pending_;
  std::optional<RunSample> before_;
};

/// Whether something touches the robot, as far as the witness knows: an obstacle or an applied wrench.
bool is_touched(const RunSample& now, Witness witness) {
  if (witness == Witness::none) return now.detection.level != ContactLevel::none;
  return now.force() > Verdict::contact_force ||
         std::hypot(now.external[0], now.external[1]) > Verdict::contact_force ||
         std::abs(now.external[2]) > Verdict::contact_moment;
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

/// The largest errors, as long as nothing has touched the robot.
void measure_errors(const RunSample& now, Verdict& verdict) {
  if (now.estimate_valid) {
    for (int i = 0; i < 3; ++i) {
      double& largest = i < 2 ? verdict.max_observer_error_force : verdict.max_observer_error_moment;
      largest = std::max(largest, std::abs(now.estimate[i] - now.external[i]));
    }
  }
  if (now.mode != ReactionMode::nominal || !now.reference_valid) return;
  const double distance = std::hypot(now.pose[0] - now.reference[0], now.pose[1] - now.reference[1]);
  const double angle = std::remainder(now.pose[2] - now.reference[2], 2.0 * M_PI);
  verdict.max_tracking_error = std::max(verdict.max_tracking_error, distance);
  verdict.max_orientation_error = std::max(verdict.max_orientation_error, std::abs(angle));
}

std::string description_of(GateFault fault) {
  for (const FaultRow& row : fault_table()) {
    if (row.fault == fault) return row.description;
  }
  return "the run was too short";
}

void expect_contact(const Verdict& verdict, const Expectations& expected,
                    std::vector<std::string>& failures) {
  if (!expected.contact) return;
  if (*expected.contact == "none") {
    if (!verdict.contacts.empty()) failures.push_back("there was a contact, though none was expected");
    return;
  }
  if (verdict.witness == Witness::none) return;
  if (verdict.contacts.empty()) {
    failures.push_back("nothing was touched, though a contact with " + *expected.contact + " was expected");
  } else if (!verdict.contacts.front().body.empty() && verdict.contacts.front().body != *expected.contact) {
    failures.push_back(verdict.contacts.front().body + " was touched instead of " + *expected.contact);
  }
}

void judge_contacts(const Verdict& verdict, const Expectations& expected,
                    std::vector<std::string>& failures) {
  for (const ContactVerdict& contact : verdict.contacts) {
    const std::string touched = contact.body.empty() ? "the pylon" : contact.body;
    if (!contact.detected) {
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

void expect_at_most(const char* what, double value, std::optional<double> bound, const char* unit,
                    double scale, std::vector<std::string>& failures) {
  if (!bound || value <= *bound) return;
  failures.push_back(fmt::format("the {} reached {:.4g} {}, above {:.4g} {}", what, scale * value, unit,
                                 scale * *bound, unit));
}

/// Measures all that a run shows, in one pass over its samples.
Verdict measure(const Recording& recording, const ForceLimits& limits, std::vector<std::string>& failures) {
  const RecordedRun run(recording);
  Verdict verdict;
  verdict.witness = run.witness();
  ContactWatch contacts(limits);
  DetectionWatch detections;
  bool was_touched = false, gate_opens = false;
  GateStatus gate;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const RunSample now = run[k];
    const bool touched = is_touched(now, verdict.witness);
    contacts.see(now, run.period());
    detections.see(now, touched, verdict);
    was_touched |= touched;
    if (!was_touched) measure_errors(now, verdict);
    if (now.is_true) verdict.loop_closure = std::max(verdict.loop_closure.value_or(0.0), now.loop_closure);
    gate = now.gate;
    gate_opens |= gate.phase == GatePhase::open;
    if (verdict.fault.empty() && gate.fault != GateFault::none) verdict.fault = description_of(gate.fault);
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

Verdict judge(const Recording& recording, const Expectations& expected, const ForceLimits& limits) {
  std::vector<std::string> of_the_gate;
  Verdict verdict = measure(recording, limits, of_the_gate);
  expect_contact(verdict, expected, verdict.failures);
  judge_contacts(verdict, expected, verdict.failures);
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
