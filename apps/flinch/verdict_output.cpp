#include "apps/flinch/verdict_output.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "apps/flinch/verdict.h"

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

Json contact_json(const ContactVerdict& contact) {
  return {{"body", contact.body},
          {"detected", contact.detected.has_value()},
          {"detection_ms", milliseconds(contact.onset, contact.detected)},
          {"removal_ms", milliseconds(contact.onset, contact.removed)},
          {"peak_force_N", contact.peak_force},
          {"limit_N", contact.limit},
          {"within_limit", contact.within_limit},
          {"limit", contact.limit_name},
          {"lasting_force_N", contact.lasting_force ? Json(*contact.lasting_force) : Json(nullptr)},
          {"onset_s", contact.onset},
          {"speed_m_per_s", contact.speed}};
}

std::string contact_line(const ContactVerdict& contact) {
  return fmt::format("{:<15} {:>8.3f} {:>6.2f} {:>10} {:>10} {:>8.0f} {:>8.0f}  {}\n", contact.body,
                     contact.onset, contact.speed, milliseconds_text(contact.onset, contact.detected),
                     milliseconds_text(contact.onset, contact.removed), contact.peak_force, contact.limit,
                     contact.within_limit ? "yes" : "NO");
}

}  // namespace

std::string verdict_table(const Verdict& verdict, const RunFacts& facts) {
  std::string text = fmt::format("{:<15} {:>8} {:>6} {:>10} {:>10} {:>8} {:>8}  {}\n", "contact with", "at s",
                                 "m/s", "noticed ms", "removed ms", "peak N", "limit N", "within");
  for (const ContactVerdict& contact : verdict.contacts) text += contact_line(contact);
  if (verdict.contacts.empty()) text += "nothing was touched\n";
  text += fmt::format(
      "\nfalse detections   {}\nobserver error     {:.2f} N, {:.3f} Nm before any contact\n"
      "tracking error     {:.2f} mm, {:.2f} deg before any contact\nloop closure       {:.1e} m\n"
      "simulated          {:.3f} s in {:.2f} s, seed {}\n\n",
      verdict.false_detections, verdict.max_observer_error_force, verdict.max_observer_error_moment,
      1e3 * verdict.max_tracking_error, verdict.max_orientation_error * 57.29577951308232,
      verdict.loop_closure, verdict.simulated, facts.wall, facts.seed);
  text += verdict.good() ? "verdict: good\n" : "verdict: bad\n";
  for (const std::string& failure : verdict.failures) text += "  - " + failure + "\n";
  return text;
}

std::string verdict_json(const Verdict& verdict, const RunFacts& facts) {
  Json contacts = Json::array();
  for (const ContactVerdict& contact : verdict.contacts) contacts.push_back(contact_json(contact));
  const Json json = {{"verdict", verdict.good() ? "good" : "bad"},
                     {"contacts", contacts},
                     {"false_detections", verdict.false_detections},
                     {"max_observer_error_N", verdict.max_observer_error_force},
                     {"max_observer_error_Nm", verdict.max_observer_error_moment},
                     {"max_tracking_error_mm", 1e3 * verdict.max_tracking_error},
                     {"loop_closure_m", verdict.loop_closure},
                     {"simulated_s", verdict.simulated},
                     {"wall_s", facts.wall},
                     {"seed", facts.seed},
                     {"fault", verdict.fault},
                     {"failures", verdict.failures}};
  return json.dump();
}

}  // namespace flinch
