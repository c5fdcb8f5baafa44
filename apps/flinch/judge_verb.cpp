// flinch judge: what a scenario's estimators and detectors make of a log.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/log_stretch.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "calibration/chi_square_quantile.h"
#include "experiments/comparison/judged_page.h"
#include "experiments/recorded/judged_log.h"
#include "experiments/recorded/measured_contacts.h"
#include "experiments/scenario/scenario.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

/// Largest rate [1/h] that still shows at most so many in the time with 5 %: Garwood (1936).
double alarms_at_most(std::size_t alarms, double seconds) {
  if (seconds <= 0.0) return std::numeric_limits<double>::infinity();
  return 0.5 * chi_square_quantile(2 * (static_cast<int>(alarms) + 1), 0.95) / (seconds / 3600.0);
}

Json delay_json(const std::vector<std::optional<double>>& delays) {
  const auto one = [](const std::optional<double>& delay) {
    return delay ? Json(1e3 * *delay) : Json(nullptr);
  };
  if (delays.size() == 1) return one(delays.front());
  Json all = Json::array();
  for (const std::optional<double>& delay : delays) all.push_back(one(delay));
  return all;
}

std::string judged_json(const JudgedLog& judged, const LogTruth& truth) {
  Json detections = Json::array(), alarms = Json::object(), at_most = Json::object(), delays = Json::object(),
       faults = Json::array();
  for (const JudgedLog::Detection& each : judged.detections)
    detections.push_back({{"by", each.by}, {"at_s", each.at}});
  for (const auto& [by, count] : judged.false_alarms) {
    alarms[by] = count;
    const double rate = alarms_at_most(count, judged.free_seconds);
    at_most[by] = std::isfinite(rate) ? Json(rate) : Json(nullptr);
  }
  for (const auto& [by, found] : judged.delays) {
    if (!found.empty()) delays[by] = delay_json(found);
  }
  for (const JudgedLog::Fault& each : judged.faults)
    faults.push_back({{"fault", each.name}, {"at_s", each.at}});
  Json contacts = Json::array();
  for (const LogTruth::Stretch& each : truth.measured)
    contacts.push_back({{"from_s", each.from}, {"to_s", each.to}});
  Json folds = Json::array();
  for (const JudgedLog::Fold& fold : judged.folds)
    folds.push_back({{"leg", fold.leg + 1}, {"at_s", fold.at}});
  return json_text(Json{{"seconds", judged.seconds},
                        {"free_seconds", judged.free_seconds},
                        {"pose_known", judged.pose_known},
                        {"folds", folds},
                        {"measured_contacts", contacts},
                        {"detections", detections},
                        {"false_alarms", alarms},
                        {"false_alarms_at_most_per_h", at_most},
                        {"detection_ms", delays},
                        {"faults", faults}});
}

/// Folds and faults, a sentence each.
std::vector<std::string> events_of(const JudgedLog& judged) {
  std::vector<std::string> events;
  if (judged.folds_from_home)
    events.emplace_back("at its begin a leg has its elbow on another side than the robot file says");
  for (const JudgedLog::Fold& fold : judged.folds)
    events.push_back(fmt::format("leg {} changes the side of its elbow at {:.3f} s", fold.leg + 1, fold.at));
  for (const JudgedLog::Fault& fault : judged.faults)
    events.push_back(fmt::format("the torque gate would have closed at {:.3f} s: {}", fault.at, fault.name));
  return events;
}

void print_judged(const JudgedLog& judged, const LogTruth& truth) {
  print_result("log:       {:.2f} s, {:.2f} s of it free; the pose is known in {:.1f} %\n", judged.seconds,
               judged.free_seconds, 100.0 * judged.pose_known);
  print_result("{:<24} {:>10} {:>12} {:>18}  {}\n", "by", "detections", "false alarms",
               "at most per h (95 %)", "contacts detected after");
  for (const std::string& by : judged.by) {
    std::string delays;
    for (const std::optional<double>& delay : judged.delays.at(by))
      delays += (delays.empty() ? "" : ", ") + (delay ? fmt::format("{:.1f} ms", 1e3 * *delay) : "missed");
    const std::size_t alarms = judged.false_alarms.at(by);
    const double rate = alarms_at_most(alarms, judged.free_seconds);
    print_result("{:<24} {:>10} {:>12} {:>18}  {}\n", by, judged.count_by(by),
                 judged.free_seconds > 0.0 ? std::to_string(alarms) : "-",
                 std::isfinite(rate) ? fmt::format("{:.0f}", rate) : "-", delays);
  }
  for (const LogTruth::Stretch& each : truth.measured)
    print_result("contact from {:.3f} to {:.3f} s, {}\n", each.from, each.to, truth.source);
  for (const std::string& event : events_of(judged)) print_result("{}\n", event);
}

void write_page(const JudgeOptions& options, const Scenario& scenario, const JudgedPage& page,
                const JudgedLog& judged, const LogTruth& truth) {
  JudgedFacts facts;
  facts.name = options.log.filename().string();
  facts.told =
      fmt::format("{:.2f} s, judged by the control path of '{}'; the pose is known in {:.1f} % of it",
                  judged.seconds, scenario.title, 100.0 * judged.pose_known);
  facts.estimator = followed_name(scenario.control.stages.estimators);
  for (const std::string& by : judged.by)
    facts.at_most[by] = alarms_at_most(judged.false_alarms.at(by), judged.free_seconds);
  facts.events = events_of(judged);
  facts.call = options.common.command_line;
  write_result(options.out, page.html(judged, truth, facts));
}

LogTruth truth_of(const JudgeOptions& options, const Recording& readings) {
  const std::vector<LogTruth::Stretch> free = stretches_of(options.free);
  if (options.truth.empty()) {
    if (options.contact_force) throw SetupError("--contact-force: is of --truth force, which is not given");
    LogTruth truth;
    truth.free = free;
    truth.contacts = options.contacts;
    return truth;
  }
  if (!options.contacts.empty())
    throw SetupError(
        "--contact: with --truth force the sensor says when contacts begin; leave one of both out");
  return measured_contacts(readings, options.contact_force, free);
}

}  // namespace

ExitStatus judge(const JudgeOptions& options) {
  require_no_kind(options.log, "a recording");
  require_output(options.out, {options.log}, OutputKind::page);
  const auto readings = std::make_shared<const Recording>(open_recording(options.log));
  const Scenario scenario =
      options.scenario.empty() ? recorded_scenario(*readings, options.log) : read_scenario(options.scenario);
  const LogTruth truth = truth_of(options, *readings);
  Progress progress("judging " + options.log.string(),
                    is_short(*readings) || options.common.quiet || options.common.json);
  std::optional<JudgedPage> page;
  if (!options.out.empty() && readings->samples() > 0)
    page.emplace(1e-9 * static_cast<double>(readings->time_ns.front()),
                 1e-9 * static_cast<double>(readings->time_ns.back()), to_seconds(scenario.control_period));
  SignalMonitor watch;
  if (page) watch = {JudgedPage::shows, [&page](const Recording& latest) { page->see(latest); }};
  const JudgedLog judged =
      judge_log(scenario, readings, truth, watch, [&progress](double share) { progress.show(share); });
  if (page) write_page(options, scenario, *page, judged, truth);
  if (options.common.json) {
    print_result("{}\n", judged_json(judged, truth));
    return ExitStatus::done;
  }
  if (readings->period != scenario.control_period && !options.common.quiet)
    print_message(
        "warning: {}: has a period of {:.3f} ms; it was interpolated to {:g} ms, that of the control, so a "
        "contact may be detected up to a sample too early\n",
        options.log.string(), 1e3 * to_seconds(readings->period), 1e3 * to_seconds(scenario.control_period));
  print_judged(judged, truth);
  if (page && !options.common.quiet) print_message("page:      {}\n", options.out.string());
  return ExitStatus::done;
}

}  // namespace flinch
