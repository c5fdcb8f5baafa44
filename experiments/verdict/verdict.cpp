#include "experiments/verdict/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "systems/framework/recording.h"
#include "systems/robot/body_id.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reaction_state.h"

namespace flinch {
namespace {

bool has_signal(const Recording& recording, const std::string& path) {
  return std::any_of(recording.signals.begin(), recording.signals.end(),
                     [&path](const Signal& signal) { return signal.path == path; });
}

Witness witness_of(const Recording& recording) {
  if (has_signal(recording, "contact") || has_signal(recording, "truth")) return Witness::truth;
  return has_signal(recording, "force_torque") ? Witness::force_torque : Witness::none;
}

/// `column` where `valid` is set, "no data" elsewhere.
std::vector<double> where(const std::vector<double>& valid, std::vector<double> column) {
  for (std::size_t k = 0; k < column.size(); ++k) {
    if (valid[k] != 1.0) column[k] = std::nan("");
  }
  return column;
}

/// The columns of a recording that a verdict rests on, one entry a sample.
struct Samples {
  explicit Samples(const Recording& recording)
      : witness(witness_of(recording)),
        period(to_seconds(recording.period)),
        level(recording.column("detection", "level")),
        present_level(recording.column("detection", "present_level")),
        mode(recording.column("reaction", "mode")),
        estimate_valid(recording.column("wrench", "valid")),
        reference_valid(recording.column("reference", "valid")),
        fault(recording.column("gate", "fault")),
        gate(recording.column("gate", "phase")),
        faults_present(recording.column("gate", "faults")) {
    for (const std::int64_t ns : recording.time_ns) time.push_back(1e-9 * static_cast<double>(ns));
    if (witness == Witness::truth) {
      take_truth(recording);
    } else {
      take_measurements(recording);
    }
    for (int i = 0; i < 3; ++i) {
      estimate.push_back(recording.column("wrench", "wrench_in_base", i));
      reference.push_back(recording.column("reference", "pose", i));
    }
  }

  std::size_t size() const { return time.size(); }
  /// Not a number where nobody measured it.
  double force(std::size_t k) const { return std::hypot(force_x[k], force_y[k]); }
  /// By the pylon or by an applied wrench, as far as the witness knows.
  bool touched(std::size_t k) const {
    if (witness == Witness::none) return level[k] > 0.0;
    return force(k) > Verdict::contact_force ||
           std::hypot(external[0][k], external[1][k]) > Verdict::contact_force ||
           std::abs(external[2][k]) > Verdict::contact_moment;
  }

  Witness witness;
  double period;
  std::vector<double> time;
  std::vector<double> force_x, force_y, body, clamping;  // the last two by the simulation only
  std::vector<double> level, present_level, mode;
  std::vector<double> estimate_valid, reference_valid, loop_closure, fault, gate, faults_present;
  std::vector<std::vector<double>> pose, velocity, external, estimate, reference;

 private:
  void take_truth(const Recording& recording) {
    force_x = recording.column("contact", "strongest.force_in_base", 0);
    force_y = recording.column("contact", "strongest.force_in_base", 1);
    body = recording.column("contact", "strongest.body");
    clamping = recording.column("contact", "clamping");
    loop_closure = recording.column("truth", "loop_closure_error");
    for (int i = 0; i < 3; ++i) {
      pose.push_back(recording.column("truth", "pose", i));
      velocity.push_back(recording.column("truth", "velocity", i));
      external.push_back(recording.column("truth", "wrench_in_base", i));
    }
  }

  /// Until something touches the robot, no wrench acts on it.
  void take_measurements(const Recording& recording) {
    force_x = force_y = std::vector<double>(time.size(), std::nan(""));
    if (witness == Witness::force_torque) {
      const std::vector<double> valid = recording.column("force_torque", "valid");
      force_x = where(valid, recording.column("force_torque", "force_in_base", 0));
      force_y = where(valid, recording.column("force_torque", "force_in_base", 1));
    }
    for (int i = 0; i < 3; ++i) {
      pose.push_back(recording.column("motion", "pose", i));
      velocity.push_back(recording.column("motion", "velocity", i));
      external.emplace_back(time.size(), 0.0);
    }
  }
};

/// First and last sample with force of each contact.
struct Span {
  std::size_t first;
  std::size_t last;
};

std::vector<Span> contact_spans(const Samples& samples) {
  std::vector<Span> spans;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!(samples.force(k) > Verdict::contact_force)) continue;
    const bool same =
        !spans.empty() && samples.time[k] - samples.time[spans.back().last] < Verdict::same_contact;
    if (same) {
      spans.back().last = k;
    } else {
      spans.push_back({k, k});
    }
  }
  return spans;
}

/// The body that is touched: a leg's clamping where that happens during the span, else the body with the peak
/// force.
std::string touched_body(const Samples& samples, const Span& span, std::size_t peak) {
  if (samples.witness != Witness::truth) return "";
  for (std::size_t k = span.first; k <= span.last; ++k) {
    if (samples.clamping[k] == 0.0) continue;
    return "leg" + std::to_string(BodyId::from_index(static_cast<int>(samples.body[k])).leg() + 1) +
           "_clamping";
  }
  return body_name(BodyId::from_index(static_cast<int>(samples.body[peak])));
}

/// The peak counts against the transient limit, what lasts longer against the quasi-static one.
void limit_force(const Samples& samples, const Span& span, const ForceLimits& limits,
                 ContactVerdict& contact) {
  for (std::size_t k = span.first; k <= span.last; ++k) {
    if (samples.time[k] - contact.onset <= limits.transient_duration) continue;
    contact.lasting_force = std::max(contact.lasting_force.value_or(0.0), samples.force(k));
  }
  const bool peak_is_good = contact.peak_force <= limits.transient;
  const bool rest_is_good = contact.lasting_force.value_or(0.0) <= limits.quasi_static;
  contact.within_limit = peak_is_good && rest_is_good;
  contact.limit = peak_is_good && !rest_is_good ? limits.quasi_static : limits.transient;
  contact.limit_name = peak_is_good && !rest_is_good ? "quasi-static" : "transient";
}

/// When the force rose above `contact_force`, between the samples before and at `first`.
double onset_of(const Samples& samples, std::size_t first) {
  if (first == 0) return samples.time[0];
  const double before = samples.force(first - 1);
  if (std::isnan(before)) return samples.time[first];
  const double share = (Verdict::contact_force - before) / (samples.force(first) - before);
  return samples.time[first - 1] + share * (samples.time[first] - samples.time[first - 1]);
}

/// When the contact was noticed. The latched level would not do: of a second contact it knows nothing.
std::optional<double> detection_of(const Samples& samples, const Span& span) {
  const double end = samples.time[span.last] + Verdict::same_contact;
  for (std::size_t k = span.first; k < samples.size() && samples.time[k] < end; ++k) {
    if (samples.present_level[k] > 0.0) return samples.time[k];
  }
  return std::nullopt;
}

ContactVerdict judge_contact(const Samples& samples, const Span& span, const ForceLimits& limits) {
  ContactVerdict contact;
  std::size_t peak = span.first;
  for (std::size_t k = span.first; k <= span.last; ++k) {
    if (samples.force(k) > samples.force(peak)) peak = k;
  }
  contact.detected = detection_of(samples, span);
  contact.body = touched_body(samples, span, peak);
  contact.onset = onset_of(samples, span.first);
  contact.peak_force = samples.force(peak);
  contact.peak_time = samples.time[peak];
  for (std::size_t k = span.first - std::min<std::size_t>(span.first, 1); k <= span.last; ++k) {
    contact.speed = std::max(contact.speed, std::hypot(samples.velocity[0][k], samples.velocity[1][k]));
  }
  if (samples.time.back() - samples.time[span.last] >= Verdict::same_contact) {
    contact.removed = samples.time[span.last] + samples.period;
  }
  limit_force(samples, span, limits, contact);
  return contact;
}

/// Also which of them were false.
void find_detections(const Samples& samples, Verdict& verdict) {
  double last_touched = -Verdict::same_contact;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    if (samples.touched(k)) last_touched = samples.time[k];
    const bool rises = samples.level[k] > 0.0 && samples.level[k - 1] == 0.0;
    if (!rises) continue;
    verdict.detections.push_back(samples.time[k]);
    if (samples.time[k] - last_touched >= Verdict::same_contact) ++verdict.false_detections;
  }
}

/// The largest errors before anything touches the robot.
void measure_errors(const Samples& samples, Verdict& verdict) {
  for (std::size_t k = 0; k < samples.size() && !samples.touched(k); ++k) {
    if (samples.estimate_valid[k] != 0.0) {
      for (std::size_t i = 0; i < 3; ++i) {
        double& largest = i < 2 ? verdict.max_observer_error_force : verdict.max_observer_error_moment;
        largest = std::max(largest, std::abs(samples.estimate[i][k] - samples.external[i][k]));
      }
    }
    const bool nominal = samples.mode[k] == static_cast<double>(ReactionMode::nominal);
    if (nominal && samples.reference_valid[k] != 0.0) {
      const double distance = std::hypot(samples.pose[0][k] - samples.reference[0][k],
                                         samples.pose[1][k] - samples.reference[1][k]);
      const double angle = std::remainder(samples.pose[2][k] - samples.reference[2][k], 2.0 * M_PI);
      verdict.max_tracking_error = std::max(verdict.max_tracking_error, distance);
      verdict.max_orientation_error = std::max(verdict.max_orientation_error, std::abs(angle));
    }
  }
}

std::string description_of(double fault) {
  for (const FaultRow& row : fault_table()) {
    if (static_cast<double>(row.fault) == fault) return row.description;
  }
  return "the run was too short";
}

std::string what_closed_the_gate(const Samples& samples) {
  const auto fault =
      std::find_if(samples.fault.begin(), samples.fault.end(), [](double f) { return f != 0.0; });
  return fault == samples.fault.end() ? "" : description_of(*fault);
}

void expect_open_gate(const Samples& samples, std::vector<std::string>& failures) {
  const auto opens = [](double phase) { return phase == static_cast<double>(GatePhase::open); };
  if (samples.size() == 0 || std::any_of(samples.gate.begin(), samples.gate.end(), opens)) return;
  const auto faults = static_cast<FaultMask>(samples.faults_present.back());
  failures.push_back("the torque gate never opened: " +
                     description_of(static_cast<double>(first_fault(faults))));
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

}  // namespace

Verdict judge(const Recording& recording, const Expectations& expected, const ForceLimits& limits) {
  const Samples samples(recording);
  Verdict verdict;
  verdict.witness = samples.witness;
  for (const Span& span : contact_spans(samples))
    verdict.contacts.push_back(judge_contact(samples, span, limits));
  find_detections(samples, verdict);
  measure_errors(samples, verdict);
  for (const double miss : samples.loop_closure) {
    verdict.loop_closure = std::max(verdict.loop_closure.value_or(0.0), miss);
  }
  verdict.fault = what_closed_the_gate(samples);
  if (samples.size() > 0) verdict.simulated = samples.time.back() - samples.time.front() + samples.period;

  expect_contact(verdict, expected, verdict.failures);
  judge_contacts(verdict, expected, verdict.failures);
  expect_open_gate(samples, verdict.failures);
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
