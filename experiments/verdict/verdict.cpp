#include "experiments/verdict/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "experiments/verdict/names_of_touched.h"
#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/run_monitor.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

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

/// What touched one another: the body, and the obstacle where more than one touched or nobody saw the body.
std::string name_of(const ContactVerdict& contact, const Verdict& verdict) {
  const std::string& obstacle = contact.obstacle_name;
  if (contact.body.empty()) return obstacle.empty() ? "an obstacle" : obstacle;
  const bool is_only_one =
      std::all_of(verdict.contacts.begin(), verdict.contacts.end(),
                  [&](const ContactVerdict& other) { return other.obstacle_name == obstacle; });
  return is_only_one || obstacle.empty() ? contact.body : contact.body + " (" + obstacle + ")";
}

/// Whether it ended, and how hard it was until then. A clamping that outlasts the transient duration is bad
/// unless the scenario says how hard it may be.
void judge_end(const ContactVerdict& contact, const std::string& touched, const Expectations& expected,
               std::vector<std::string>& failures) {
  if (expected.removal_time && !contact.removed) {
    failures.push_back(
        fmt::format("the contact with {} was not over at the end, and should be after {:.1f} ms", touched,
                    1e3 * *expected.removal_time));
  } else if (expected.removal_time && *contact.removed - contact.onset > *expected.removal_time) {
    failures.push_back(fmt::format("the contact with {} was over after {:.1f} ms, later than {:.1f} ms",
                                   touched, 1e3 * (*contact.removed - contact.onset),
                                   1e3 * *expected.removal_time));
  }
  if (!contact.lasting_force) return;
  if (expected.lasting_force && *contact.lasting_force > *expected.lasting_force) {
    failures.push_back(fmt::format("the force on {} lasted at {:.0f} N, above {:.0f} N", touched,
                                   *contact.lasting_force, *expected.lasting_force));
  }
  if (!expected.lasting_force && !expected.removal_time && !contact.removed &&
      contact.body.ends_with("_clamping")) {
    failures.push_back(
        fmt::format("the clamping {} was not released; where that is right, 'expect.lasting_force_N' says "
                    "how hard it may be",
                    touched));
  }
}

void judge_contacts(const Verdict& verdict, const Expectations& expected,
                    std::vector<std::string>& failures) {
  for (const ContactVerdict& contact : verdict.contacts) {
    const std::string touched = name_of(contact, verdict);
    const bool is_load = contact.is_push && expected.contact == "none";
    if (!contact.detected) {
      if (is_load) continue;
      failures.push_back("the contact with " + touched + " was not detected");
    } else if (expected.detection_time && *contact.detected - contact.onset > *expected.detection_time) {
      failures.push_back(fmt::format("the contact with {} was detected after {:.1f} ms, later than {:.1f} ms",
                                     touched, 1e3 * (*contact.detected - contact.onset),
                                     1e3 * *expected.detection_time));
    }
    if (!is_load) judge_end(contact, touched, expected, failures);
    if (!contact.within_limit) {
      const bool lasts = contact.limit_name == "quasi-static";
      failures.push_back(fmt::format(
          "the force on {} {} {:.0f} N, above the {} limit of {:.0f} N, for {:.0f} ms in all", touched,
          lasts ? "stayed at" : "reached", lasts ? *contact.lasting_force : contact.peak_force,
          contact.limit_name, contact.limit, 1e3 * contact.over_limit));
    }
  }
}

/// What was touched, as somebody saw or as was expected; "": nobody knows.
std::string body_of(const ContactVerdict& contact, const Expectations& expected) {
  return contact.body.empty() && expected.contact != "none" ? expected.contact.value_or("") : contact.body;
}

void remark_contacts(const Verdict& verdict, const Expectations& expected,
                     std::vector<std::string>& remarks) {
  for (const ContactVerdict& contact : verdict.contacts) {
    if (!contact.removed)
      remarks.push_back("the contact with " + name_of(contact, verdict) + " was not over at the end");
    const std::string body = body_of(contact, expected);
    if (contact.classified.empty() || body.empty() || names_body(contact.classified, body)) continue;
    remarks.push_back(fmt::format(
        "the contact with {} was taken for one with {}, with probability {:.3f}; see control.isolation", body,
        contact.classified, contact.probability));
  }
}

void remark_self_contacts(const Verdict& verdict, std::vector<std::string>& remarks) {
  for (const SelfContact& contact : verdict.self_contacts) {
    remarks.push_back(
        contact.body.empty()
            ? fmt::format("bodies of the robot touched one another from {:.3f} s on", contact.since)
            : fmt::format("{} touched {} from {:.3f} s on", contact.body, contact.other, contact.since));
  }
}

void remark_lost_sensors(const Verdict& verdict, std::vector<std::string>& remarks) {
  if (verdict.imu_doubt != ImuFault::none) {
    remarks.push_back(fmt::format("the IMU was left out from {:.3f} s on: {}", verdict.imu_doubted,
                                  name(verdict.imu_doubt)));
  }
  if (verdict.passive_lost) {
    remarks.push_back(
        fmt::format("there were no passive encoders from {:.3f} s on: drives might turn half as fast",
                    *verdict.passive_lost));
  }
}

/// What closed the gate. Where the robot is expected to be brought back, only what did after the reset is a
/// failure.
void judge_gate(Verdict& verdict, const Expectations& expected) {
  const bool is_reset = expected.return_time && verdict.returned;
  const std::string closed = "the torque gate closed: " + verdict.fault;
  if (!is_reset && !verdict.fault.empty()) verdict.failures.push_back(closed);
  if (!is_reset) return;
  if (!verdict.returned->stopped_by.empty()) verdict.remarks.push_back(closed);
  if (!verdict.returned->fault.empty())
    verdict.failures.push_back("the torque gate closed after the reset: " + verdict.returned->fault);
}

void expect_return(const std::optional<Return>& seen, const std::optional<double>& bound,
                   std::vector<std::string>& failures) {
  if (!bound) return;
  if (!seen) {
    failures.emplace_back("no operator has reset the robot while it was kept from its nominal motion");
  } else if (!seen->resumed) {
    failures.emplace_back("the nominal motion did not begin again");
  } else if (*seen->resumed - seen->reset > *bound) {
    failures.push_back(
        fmt::format("the nominal motion began again {:.2f} s after the reset, later than {:.2f} s",
                    *seen->resumed - seen->reset, *bound));
  }
}

void expect_at_most(const char* what, double value, std::optional<double> bound, const char* unit,
                    double scale, std::vector<std::string>& failures) {
  if (!bound || value <= *bound) return;
  failures.push_back(fmt::format("the {} reached {:.4g} {}, above {:.4g} {}", what, scale * value, unit,
                                 scale * *bound, unit));
}

std::optional<ComputerLateness> computer_of(const Recording& recording) {
  const auto number = [&recording](const char* name) -> std::optional<std::int64_t> {
    const auto found = recording.attributes.find(name);
    if (found == recording.attributes.end()) return std::nullopt;
    std::int64_t value = 0;
    const char* const end = found->second.data() + found->second.size();
    return std::from_chars(found->second.data(), end, value).ptr == end ? std::optional(value) : std::nullopt;
  };
  const auto lost = number("loop.lost_periods");
  if (!lost || *lost < 0) return std::nullopt;
  const auto p99 = number("loop.lateness_p99_ns");
  return ComputerLateness{*lost, p99 ? std::optional(1e-9 * static_cast<double>(*p99)) : std::nullopt};
}

/// What came in the way of the run from outside, before all that followed from it.
void judge_circumstances(const Recording& recording, Verdict& verdict) {
  const auto failure = recording.attributes.find("run.failure");
  if (failure != recording.attributes.end())
    verdict.failures.insert(verdict.failures.begin(), failure->second);
  verdict.computer = computer_of(recording);
  const std::string late = lateness_sentence(verdict);
  if (late.empty()) return;
  std::vector<std::string>& sentences = verdict.good() ? verdict.remarks : verdict.failures;
  sentences.insert(sentences.begin(), late);
}

}  // namespace

Verdict judge(const RunMonitor& watch, const Expectations& expected) {
  Verdict verdict = watch.seen();
  const std::vector<std::string> of_the_gate = std::exchange(verdict.failures, {});
  expect_contact(verdict, expected, verdict.failures);
  judge_contacts(verdict, expected, verdict.failures);
  remark_contacts(verdict, expected, verdict.remarks);
  remark_self_contacts(verdict, verdict.remarks);
  remark_lost_sensors(verdict, verdict.remarks);
  verdict.failures.insert(verdict.failures.end(), of_the_gate.begin(), of_the_gate.end());
  if (verdict.false_detections > 0) verdict.failures.push_back("a contact was detected where there was none");
  judge_gate(verdict, expected);
  expect_return(verdict.returned, expected.return_time, verdict.failures);
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

Verdict judge(const Recording& recording, const ConfigurationSpace& space, const Expectations& expected,
              const ForceLimits& limits, const std::function<void(double)>& progress) {
  const RecordedRun run(recording, space);
  RunMonitor watch(run, limits);
  for (std::size_t k = 0; k < run.size(); ++k) {
    if (progress && k % Recording::block == 0)
      progress(static_cast<double>(k) / static_cast<double>(run.size()));
    watch.see(run[k]);
  }
  Verdict verdict = judge(watch, expected);
  const auto partial = recording.attributes.find("recording.partial");
  if (partial != recording.attributes.end()) verdict.remarks.push_back(partial->second);
  judge_circumstances(recording, verdict);
  return verdict;
}

std::string lateness_sentence(const Verdict& verdict) {
  if (!verdict.computer || verdict.computer->ticks_lost == 0) return "";
  const std::int64_t lost = verdict.computer->ticks_lost;
  return fmt::format("this computer lost {} {}; 'flinch link' tells why", lost, lost == 1 ? "tick" : "ticks");
}

}  // namespace flinch
