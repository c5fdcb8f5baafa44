#include "experiments/verdict/verdict_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/verdict/body_regions.h"
#include "experiments/verdict/task_words.h"
#include "experiments/verdict/verdict.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

/// `end` - `start` in ms; null where it has no end.
Json milliseconds(double start, const std::optional<double>& end) {
  return end ? Json(1e3 * (*end - start)) : Json(nullptr);
}

std::string milliseconds_text(double start, const std::optional<double>& end) {
  return end ? fmt::format("{:.1f}", 1e3 * (*end - start)) : "never";
}

Json by_estimator(const ContactVerdict& contact) {
  Json times = Json::object();
  for (const DetectionBy& by : contact.detected_by) {
    if (!by.estimator.empty()) times[by.estimator] = milliseconds(contact.onset, by.detected);
  }
  return times;
}

/// What the reaction did, and since when.
Json reaction_tasks_json(const ContactVerdict& contact) {
  Json tasks = Json::array();
  for (const auto& [task, time] : contact.reaction_tasks) {
    tasks.push_back({{"task", word(task.kind)},
                     {"leg", task.leg < 0 ? Json(nullptr) : Json(std::int64_t{task.leg} + 1)},
                     {"ms", milliseconds(contact.onset, time)}});
  }
  return tasks;
}

Json contact_json(const ContactVerdict& contact) {
  return {{"body", contact.body.empty() ? Json(nullptr) : Json(contact.body)},
          {"obstacle", contact.obstacle_name.empty() ? Json(nullptr) : Json(contact.obstacle_name)},
          {"pushed", contact.is_push},
          {"detected", contact.detected.has_value()},
          {"detection_ms", milliseconds(contact.onset, contact.detected)},
          {"detection_by_estimator_ms", by_estimator(contact)},
          {"classified", contact.classified.empty() ? Json(nullptr) : Json(contact.classified)},
          {"classified_ms", milliseconds(contact.onset, contact.classified_at)},
          {"probability", contact.classified_at ? Json(contact.probability) : Json(nullptr)},
          {"several_contacts", contact.several_contacts ? Json(*contact.several_contacts) : Json(nullptr)},
          {"location_error_mm", contact.location_error ? Json(1e3 * *contact.location_error) : Json(nullptr)},
          {"force_error_N", contact.force_error ? Json(*contact.force_error) : Json(nullptr)},
          {"contacts_located",
           contact.contacts_located ? Json(std::int64_t{*contact.contacts_located}) : Json(nullptr)},
          {"base_location_error_mm",
           contact.base_location_error ? Json(1e3 * *contact.base_location_error) : Json(nullptr)},
          {"could_stop_within_limits", contact.could_stop ? Json(*contact.could_stop) : Json(nullptr)},
          {"stop_ms", milliseconds(0.0, contact.stop_duration)},
          {"reaction_tasks", reaction_tasks_json(contact)},
          {"removal_ms", milliseconds(contact.onset, contact.removed)},
          {"peak_force_N", contact.peak_force},
          {"limit_N", contact.limit},
          {"within_limit", contact.within_limit},
          {"limit", contact.limit_name},
          {"over_limit_ms", 1e3 * contact.over_limit},
          {"lasting_force_N", contact.lasting_force ? Json(*contact.lasting_force) : Json(nullptr)},
          {"onset_s", contact.onset},
          {"speed_m_per_s", contact.speed}};
}

std::string told_body(const ContactVerdict& contact) {
  if (contact.body.empty()) return "not measured";
  return contact.is_push ? contact.body + ", push" : contact.body;
}

std::string contact_line(const ContactVerdict& contact) {
  return fmt::format("{:<15} {:>8.3f} {:>6.2f} {:>11} {:>10} {:>8.0f} {:>8.0f}  {:<12} {:>8.0f}  {}\n",
                     told_body(contact), contact.onset, contact.speed,
                     milliseconds_text(contact.onset, contact.detected),
                     milliseconds_text(contact.onset, contact.removed), contact.peak_force, contact.limit,
                     contact.limit_name, 1e3 * contact.over_limit, contact.within_limit ? "yes" : "NO");
}

/// What contacts are judged by, and where the numbers are from.
std::string limit_lines(const Verdict& verdict) {
  if (verdict.contacts.empty()) return "";
  const ForceLimits& limits = verdict.limits;
  return fmt::format(
      "\nforce limits       {}\n  transient        {:.0f} N, {}\n  quasi-static     {:.0f} N after {:.0f} "
      "ms, {}\n",
      region_of(limits), limits.transient, limits.transient_source, limits.quasi_static,
      1e3 * limits.transient_duration, limits.quasi_static_source);
}

Json limits_json(const ForceLimits& limits) {
  return {{"region", limits.region},
          {"transient_N", limits.transient},
          {"transient_source", limits.transient_source},
          {"quasi_static_N", limits.quasi_static},
          {"quasi_static_source", limits.quasi_static_source},
          {"transient_duration_ms", 1e3 * limits.transient_duration}};
}

/// Where there were several contacts: with which obstacle this is one.
std::string obstacle_line(const ContactVerdict& contact, const Verdict& verdict) {
  if (verdict.contacts.size() < 2 || contact.obstacle_name.empty()) return "";
  return "  by " + contact.obstacle_name + "\n";
}

Json self_contacts_json(const Verdict& verdict) {
  Json contacts = Json::array();
  for (const SelfContact& contact : verdict.self_contacts) {
    const auto name = [](const std::string& body) { return body.empty() ? Json(nullptr) : Json(body); };
    contacts.push_back({{"bodies", {name(contact.body), name(contact.other)}}, {"since_s", contact.since}});
  }
  return contacts;
}

/// Where several estimators ran: what each of them would have detected when.
std::string by_estimator_lines(const ContactVerdict& contact) {
  if (contact.detected_by.size() < 2) return "";
  std::string lines;
  for (const DetectionBy& by : contact.detected_by) {
    lines += fmt::format("  by {:<26} {:>11}\n", by.estimator, milliseconds_text(contact.onset, by.detected));
  }
  return lines;
}

/// What the robot took for touched, and how far off.
std::string classified_line(const ContactVerdict& contact) {
  if (!contact.detected) return "";
  const std::string several =
      contact.several_contacts.value_or(false) ? "; no single contact explains the wrench" : "";
  if (!contact.classified_at) return "  taken for: nothing that is sure enough to act upon" + several + "\n";
  std::string line =
      fmt::format("  taken for {} after {:.1f} ms, with probability {:.3f}", contact.classified,
                  1e3 * (*contact.classified_at - contact.onset), contact.probability);
  if (contact.location_error) {
    line += fmt::format("; at that moment placed {:.0f} mm off, the estimate of the force still {:.0f} N off",
                        1e3 * *contact.location_error, contact.force_error.value_or(0.0));
  }
  return line + several + "\n";
}

/// What wrench and base forces tell together.
std::string located_line(const ContactVerdict& contact) {
  if (!contact.contacts_located) return "";
  if (*contact.contacts_located == 0)
    return "  by the base forces: neither one nor two contacts explain it\n";
  return fmt::format("  by the base forces: {}, this one placed {:.0f} mm off\n",
                     *contact.contacts_located == 1 ? "one contact" : "two contacts",
                     1e3 * contact.base_location_error.value_or(0.0));
}

/// What the reaction did.
std::string reaction_lines(const ContactVerdict& contact) {
  std::string lines;
  for (const auto& [task, time] : contact.reaction_tasks)
    lines += fmt::format("  after {:.1f} ms it {}\n", 1e3 * (time - contact.onset), in_words(task));
  return lines;
}

/// Whether the limits could still be kept.
std::string braking_line(const ContactVerdict& contact) {
  if (!contact.could_stop) return "";
  if (!*contact.could_stop || !contact.stop_duration)
    return "  when detected it could not stop straight within the limits that it keeps\n";
  return fmt::format("  when detected it could stop within the limits that it keeps, in {:.0f} ms\n",
                     1e3 * *contact.stop_duration);
}

/// How the robot was brought back.
std::string return_lines(const std::optional<Return>& seen) {
  if (!seen) return "";
  std::string text = fmt::format("\nreset from {:<7} at {:.3f} s", seen->from, seen->reset);
  if (!seen->stopped_by.empty()) text += ", where the gate had closed: " + seen->stopped_by;
  text += seen->resumed ? fmt::format("\n  nominal motion   at {:.3f} s, {:.2f} s later", *seen->resumed,
                                      *seen->resumed - seen->reset)
                        : std::string("\n  nominal motion   never again");
  text += fmt::format("; {} {}, {} new {}", seen->resets, seen->resets == 1 ? "reset" : "resets",
                      seen->reactions, seen->reactions == 1 ? "reaction" : "reactions");
  return text + fmt::format("\n  on the way       at most {:.3f} m/s recovering, {:.3f} m/s nominal\n",
                            seen->recovery_speed, seen->nominal_speed);
}

std::string no_contact_line(const Verdict& verdict) {
  if (!verdict.contacts.empty()) return "";
  if (verdict.witness != Witness::none) return "nothing was touched\n";
  std::string times;
  for (const double time : verdict.detections) times += fmt::format(" {:.3f} s", time);
  return "no instrument saw what touched the robot; detected at:" + (times.empty() ? " never" : times) + "\n";
}

/// What nobody could ask of sensors and drives, above all the rest.
std::string checks_off_lines(const Verdict& verdict) {
  std::string lines;
  for (const std::string& check : verdict.checks_off)
    lines += fmt::format("{:<18} {}\n", lines.empty() ? "checks off" : "", check);
  return lines.empty() ? "" : lines + "\n";
}

/// How the drives answered before the first motion; none where nobody has asked them.
std::vector<double> drive_gains(const DriveCheckStatus& check) {
  const double* const begin = check.gain.data();
  const double* const end = begin + check.gain.size();
  return {begin, std::find_if_not(begin, end, [](double gain) { return std::isfinite(gain); })};
}

std::string drive_check_line(const DriveCheckStatus& check) {
  if (check.phase == DriveCheckStatus::Phase::unwanted) return "";
  const std::vector<double> gains = drive_gains(check);
  std::string text =
      gains.empty() ? "none: the robot was not held at rest for so long" : "before the first motion, gains";
  for (const double gain : gains) text += fmt::format(" {:.2f}", gain);
  return fmt::format("drives checked     {}\n", text);
}

Json robot_json(const RunFacts& facts) {
  if (facts.robot.empty()) return nullptr;
  Json robot = Json::object();
  for (const auto& [key, values] : facts.robot) robot[key] = values;
  return robot;
}

Json imu_doubt_json(const Verdict& verdict) {
  if (verdict.imu_doubt == ImuFault::none) return nullptr;
  return {{"kind", name(verdict.imu_doubt)}, {"since_s", verdict.imu_doubted}};
}

Json computer_json(const Verdict& verdict) {
  if (!verdict.computer) return nullptr;
  const ComputerLateness& computer = *verdict.computer;
  return {{"ticks_lost", computer.ticks_lost},
          {"late_ms_p99", computer.p99 ? Json(1e3 * *computer.p99) : Json(nullptr)}};
}

Json return_json(const std::optional<Return>& seen) {
  if (!seen) return nullptr;
  return {{"from", seen->from},
          {"stopped_by", seen->stopped_by},
          {"reset_s", seen->reset},
          {"resumed_s", seen->resumed ? Json(*seen->resumed) : Json(nullptr)},
          {"resets", seen->resets},
          {"reactions", seen->reactions},
          {"recovery_speed_m_per_s", seen->recovery_speed},
          {"nominal_speed_m_per_s", seen->nominal_speed},
          {"fault", seen->fault}};
}

const char* name(Witness witness) {
  switch (witness) {
    case Witness::truth:
      return "truth";
    case Witness::force_torque:
      return "force_torque";
    case Witness::none:
      break;
  }
  return "none";
}

}  // namespace

std::string verdict_table(const Verdict& verdict, const RunFacts& facts) {
  const std::string late = lateness_sentence(verdict);
  std::string text = (late.empty() ? "" : late + "\n\n") + checks_off_lines(verdict);
  text +=
      fmt::format("{:<15} {:>8} {:>6} {:>11} {:>10} {:>8} {:>8}  {:<12} {:>8}  {}\n", "contact with", "at s",
                  "m/s", "detected ms", "removed ms", "peak N", "limit N", "kind", "above ms", "within");
  for (const ContactVerdict& contact : verdict.contacts) {
    text += contact_line(contact) + obstacle_line(contact, verdict) + by_estimator_lines(contact) +
            classified_line(contact) + located_line(contact) + braking_line(contact) +
            reaction_lines(contact);
  }
  text += no_contact_line(verdict) + limit_lines(verdict) + return_lines(verdict.returned);
  text += fmt::format(
      "\nfalse detections   {}\nobserver error     {:.2f} N, {:.3f} Nm before any contact\n"
      "tracking error     {:.2f} mm, {:.2f} deg before any contact\n",
      verdict.witness == Witness::none ? "not judged" : std::to_string(verdict.false_detections),
      verdict.max_observer_error_force, verdict.max_observer_error_moment, 1e3 * verdict.max_tracking_error,
      verdict.max_orientation_error * 57.29577951308232);
  text += drive_check_line(verdict.drive_check);
  if (verdict.loop_closure) text += fmt::format("loop closure       {:.1e} m\n", *verdict.loop_closure);
  text += fmt::format("{:<18} {:.3f} s in {:.2f} s, seed {}\n\n",
                      verdict.witness == Witness::truth ? "simulated" : "ran", verdict.simulated, facts.wall,
                      facts.seed);
  if (!facts.robot.empty())
    text.insert(text.size() - 1, "robot              drawn by the seed, see the report\n");
  text += verdict.good() ? "verdict: good" : "verdict: bad";
  text += verdict.good() && !verdict.remarks.empty() ? ", but\n" : "\n";
  for (const std::string& failure : verdict.failures) text += "  - " + failure + "\n";
  for (const std::string& remark : verdict.remarks) text += "  - " + remark + "\n";
  return text;
}

std::string verdict_json(const Verdict& verdict, const RunFacts& facts) {
  Json contacts = Json::array();
  for (const ContactVerdict& contact : verdict.contacts) contacts.push_back(contact_json(contact));
  const Json json = {
      {"verdict", verdict.good() ? "good" : "bad"},
      {"witness", name(verdict.witness)},
      {"contacts", contacts},
      {"force_limits", limits_json(verdict.limits)},
      {"detections_s", verdict.detections},
      {"false_detections", verdict.false_detections},
      {"max_observer_error_N", verdict.max_observer_error_force},
      {"max_observer_error_Nm", verdict.max_observer_error_moment},
      {"max_tracking_error_mm", 1e3 * verdict.max_tracking_error},
      {"loop_closure_m", verdict.loop_closure ? Json(*verdict.loop_closure) : Json(nullptr)},
      {"simulated_s", verdict.simulated},
      {"wall_s", facts.wall},
      {"seed", facts.seed},
      {"robot_drawn", robot_json(facts)},
      {"self_contacts", self_contacts_json(verdict)},
      {"imu_doubt", imu_doubt_json(verdict)},
      {"passive_encoders_lost_s", verdict.passive_lost ? Json(*verdict.passive_lost) : Json(nullptr)},
      {"returned", return_json(verdict.returned)},
      {"computer", computer_json(verdict)},
      {"fault", verdict.fault},
      {"drive_gains", drive_gains(verdict.drive_check)},
      {"checks_off", verdict.checks_off},
      {"failures", verdict.failures},
      {"remarks", verdict.remarks}};
  return json_text(json);
}

}  // namespace flinch
