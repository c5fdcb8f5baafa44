#include "experiments/report/experiment_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "experiments/recorded/robot_as_drawn.h"
#include "experiments/report/drawn_robot.h"
#include "experiments/report/limit_lane.h"
#include "experiments/report/page_samples.h"
#include "experiments/report/report_samples.h"
#include "experiments/report/scenario_verdict.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/body_regions.h"
#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// "leg1_link2" as a reader says it.
std::string spoken(const std::string& body) {
  if (body.empty()) return "robot";
  if (body == "platform") return body;
  const std::string leg = body.substr(3, 1);
  if (body.ends_with("link1")) return "first link of leg " + leg;
  if (body.ends_with("link2")) return "second link of leg " + leg;
  return "both links of leg " + leg + " (clamping)";
}

/// The obstacle, or what else acted.
std::string object_of(const ContactVerdict& contact, const std::vector<ScenarioObstacle>& obstacles) {
  if (contact.is_push) return "push";
  if (!contact.obstacle_name.empty()) return contact.obstacle_name;
  const auto place = static_cast<std::size_t>(contact.obstacle);
  return place < obstacles.size() ? obstacles[place].name : "obstacle";
}

/// The limit that decides, whose it is and where it is from.
void judge_force(const ContactVerdict& contact, const ForceLimits& limits, ReportContact& row) {
  const bool lasts = contact.limit_name == "quasi-static";
  row.peak_force = contact.peak_force;
  row.peak_time = contact.peak_time;
  if (lasts) row.lasting_force = contact.lasting_force;
  row.force_limit = contact.limit;
  row.limit_name = fmt::format("{}, {}; {}", contact.limit_name, region_of(limits),
                               lasts ? limits.quasi_static_source : limits.transient_source);
  row.over_limit = contact.over_limit;
  row.within_limit = contact.within_limit;
}

ReportContact report_contact(const ContactVerdict& contact, const ForceLimits& limits,
                             const std::vector<ScenarioObstacle>& obstacles) {
  ReportContact row;
  row.body = spoken(contact.body);
  if (contact.body.ends_with("clamping")) row.clamping_leg = "leg " + contact.body.substr(3, 1);
  if (!contact.classified.empty()) row.isolated_body = spoken(contact.classified);
  row.several_contacts = contact.several_contacts.value_or(false);
  row.object = object_of(contact, obstacles);
  row.start = contact.onset;
  row.detected = contact.detected;
  if (contact.detected_by.size() > 1) {
    for (const DetectionBy& by : contact.detected_by) row.detected_by.emplace_back(by.estimator, by.detected);
  }
  row.could_stop = contact.could_stop;
  row.removed = contact.removed;
  row.speed = contact.speed;
  judge_force(contact, limits, row);
  return row;
}

ReportMeasure measure(std::string name, double value, std::string unit, std::optional<double> bound,
                      std::string note) {
  ReportMeasure row;
  row.name = std::move(name);
  row.value = value;
  row.unit = std::move(unit);
  row.bound = bound;
  if (bound) row.good = value <= *bound;
  row.note = std::move(note);
  return row;
}

std::vector<ReportMeasure> measures(const Verdict& verdict, const Expectations& expected) {
  const std::string before = "largest before anything touched the robot";
  const auto millimetres = [](const std::optional<double>& metres) {
    return metres ? std::optional(1e3 * *metres) : std::nullopt;
  };
  std::vector<ReportMeasure> rows = {
      measure("False detections", verdict.false_detections, "", 0.0, "contacts seen where there was none"),
      measure("Observer error, force", verdict.max_observer_error_force, "N", expected.observer_error,
              before),
      measure("Observer error, moment", verdict.max_observer_error_moment, "Nm",
              expected.observer_error_moment, before),
      measure("Tracking error", 1e3 * verdict.max_tracking_error, "mm", millimetres(expected.tracking_error),
              before),
      measure("Orientation error", verdict.max_orientation_error * 180.0 / M_PI, "deg", std::nullopt,
              before)};
  if (verdict.loop_closure) {
    rows.push_back(measure("Loop closure", *verdict.loop_closure, "m", expected.loop_closure,
                           "largest miss of a leg followed along its joint angles"));
  }
  return rows;
}

std::string caveat(Witness witness) {
  const std::string common =
      " flinch is not a certified safety function. Its verdicts on forces are engineering estimates: take "
      "limits from the standard itself.";
  switch (witness) {
    case Witness::truth:
      return "Simulation." + common;
    case Witness::force_torque:
      return "Measured: contact forces by the force-torque sensor below the pylon, motions by the controller "
             "itself." +
             common;
    case Witness::none:
      break;
  }
  return "No instrument measured contact forces; contacts are not judged." + common;
}

/// Nothing where the page shows every sample.
std::string thinning(const Recording& recording) {
  const std::size_t together = samples_in_one(recording.samples());
  if (together == 1) return "";
  return fmt::format(
      " The recording is long: {} samples each are shown as one, every chart by its peak, the robot at the "
      "hardest contact.",
      together);
}

/// The lines across the charts. Those of one value are one line.
class Bounds {
 public:
  void add(const std::string& chart, const std::string& name, double value) {
    if (!std::isfinite(value)) return;
    for (ReportBound& line : lines) {
      if (line.chart != chart || line.value != value) continue;
      if (line.name.find(name) == std::string::npos) line.name += ", " + name;
      return;
    }
    lines.push_back({chart, name, value});
  }

  void add(const std::string& chart, const std::string& name, double sign, const ComponentBounds& bounds) {
    constexpr std::string_view axes = "xyz";
    const std::vector<double>& values = bounds.values();
    for (std::size_t i = 0; i < values.size(); ++i)
      add(chart, values.size() == 1 ? name : name + " " + axes.at(i), sign * values[i]);
  }

  std::vector<ReportBound> lines;
};

/// The values to which a task law has led the measures of the workspace in this run.
void add_led(const ConstraintSettings& constraints, const Report& report, Bounds& bounds) {
  if (report.columns.count("sigma_kappa_reference") == 0) return;
  bounds.add("sigma_kappa", "activation value", constraints.sigma_kappa.activation);
  bounds.add("sigma_kappa", "safety value", constraints.sigma_kappa.safety);
  bounds.add("sigma_sc", "activation value", constraints.sigma_sc.activation);
  bounds.add("sigma_sc", "safety value", constraints.sigma_sc.safety);
}

/// The limits within which torques were kept in this run.
void add_kept(const SafetyFilterSettings& limits, const Report& report, Bounds& bounds) {
  const bool were_kept = std::any_of(report.lanes.begin(), report.lanes.end(),
                                     [](const ReportLane& lane) { return lane.name == LimitLane::name; });
  if (!were_kept) return;
  const std::string kept = "limit that is kept";
  bounds.add("sigma_kappa", kept, limits.limits.max_condition_number);
  if (limits.limits.workspace.min_self_collision_distance > 0.0)
    bounds.add("sigma_sc", kept, limits.limits.workspace.min_self_collision_distance);
  bounds.add("speed", kept, limits.max_platform_speed);
}

std::vector<ReportBound> bounds_of(const Scenario& scenario, const Verdict& verdict, const Report& report) {
  const ContactDetectorSettings detector =
      scenario.control.detector_of(followed_name(scenario.control.stages.estimators));
  Bounds bounds;
  for (const double sign : {1.0, -1.0}) {
    bounds.add("force", "reaction threshold", sign, detector.reaction.force);
    bounds.add("force", "hard threshold", sign * detector.hard.force);
    bounds.add("moment", "reaction threshold", sign, detector.reaction.moment);
    bounds.add("moment", "hard threshold", sign * detector.hard.moment);
  }
  for (const ContactVerdict& contact : verdict.contacts) {
    bounds.add("contact_force", "transient limit", verdict.limits.transient);
    if (contact.lasting_force) bounds.add("contact_force", "quasi-static limit", verdict.limits.quasi_static);
  }
  add_led(scenario.control.tasks.constraints, report, bounds);
  add_kept(scenario.control.limits, report, bounds);
  bounds.add("sigma_sc", "torque gate closes", scenario.robot.limits.min_self_collision_distance);
  return bounds.lines;
}

std::vector<ReportParameter> parameters(const std::string& group, const std::vector<ReadValue>& values) {
  std::vector<ReportParameter> rows;
  for (const ReadValue& value : values) {
    const std::size_t dot = value.key.find('.');
    const bool nested = dot != std::string::npos;
    rows.push_back({nested ? group + ": " + value.key.substr(0, dot) : group,
                    nested ? value.key.substr(dot + 1) : value.key, value.value, value.unit,
                    value.from_file ? "from the file" : "default"});
  }
  return rows;
}

/// As they took effect: the seed may come from the command line. In which folder the robot file lay is left
/// out, so that a recording gives the same page wherever it is; title and description head the page.
std::vector<ReportParameter> scenario_parameters(const Scenario& scenario) {
  std::vector<ReportParameter> rows = parameters("scenario", scenario.values);
  std::erase_if(rows,
                [](const ReportParameter& row) { return row.name == "title" || row.name == "description"; });
  for (ReportParameter& row : rows) {
    if (row.group.starts_with("scenario: calibrations"))
      row.value = std::filesystem::path(row.value).filename().string();
    if (row.group != "scenario") continue;
    if (row.name == "robot") row.value = scenario.robot_file.filename().string();
    if (row.name != "seed" || row.value == std::to_string(scenario.seed)) continue;
    row.value = std::to_string(scenario.seed);
    row.note = "from the command line";
  }
  return rows;
}

/// What was drawn of the robot, for it is no value of any file.
std::vector<ReportParameter> drawn_parameters(const Recording& recording) {
  std::vector<ReportParameter> rows;
  for (const auto& [key, values] : robot_as_drawn(recording)) {
    rows.push_back(
        {"robot as drawn", key, fmt::format("[{:.4g}]", fmt::join(values, ", ")), "", "by the seed"});
  }
  return rows;
}

std::vector<ReportParameter> provenance(const Recording& recording) {
  std::vector<ReportParameter> rows;
  for (const auto& [name, text] : recording.attributes) {
    if (!name.ends_with(".text")) rows.push_back({"", name, text, "", ""});
  }
  return rows;
}

}  // namespace

Report planned_report(const Scenario& scenario) {
  Report report;
  report.title = scenario.title;
  report.subtitle = scenario.description;
  const ParallelRobot& robot = *scenario.robot.robot;
  report.robot = drawn_robot(robot);
  report.drive_unit = robot.drive_kind(0) == DriveKind::revolute ? "Nm" : "N";
  for (const ScenarioObstacle& obstacle : scenario.obstacles) {
    report.obstacles.push_back(drawn_obstacle(obstacle.name, obstacle.shape, obstacle.position_in_base));
  }
  report.bounds = bounds_of(scenario, Verdict{}, report);
  return report;
}

Report experiment_report(const Scenario& scenario, const Recording& recording, const Verdict& verdict,
                         const std::function<void(double share)>& progress) {
  Report report = planned_report(scenario);
  report.kind = verdict.witness == Witness::truth ? "simulated experiment" : "experiment on a robot";
  report.note = caveat(verdict.witness) + thinning(recording);
  report.good = verdict.good();
  report.reasons = verdict.failures;
  report.remarks = verdict.remarks;
  report.checks_off = verdict.checks_off;
  report.fault = verdict.fault;
  report.contacts_known = verdict.witness != Witness::none;
  for (const ContactVerdict& contact : verdict.contacts)
    report.contacts.push_back(report_contact(contact, verdict.limits, scenario.obstacles));
  report.measures = measures(verdict, scenario.expected);
  add_samples(*scenario.robot.robot, recording, report, samples_in_one(recording.samples()), progress);
  report.bounds = bounds_of(scenario, verdict, report);
  report.parameters = scenario_parameters(scenario);
  for (ReportParameter& row : parameters("robot", scenario.robot.values))
    report.parameters.push_back(std::move(row));
  for (ReportParameter& row : drawn_parameters(recording)) report.parameters.push_back(std::move(row));
  report.provenance = provenance(recording);
  report.texts = {{"Scenario " + scenario.file.filename().string(), scenario.text},
                  {"Robot " + scenario.robot_file.filename().string(), scenario.robot_text}};
  for (const ParameterFile& file : scenario.calibrations) {
    const std::string name = std::filesystem::path(file.file).filename().string();
    report.texts.push_back({"Calibration " + name, file.text});
  }
  return report;
}

std::pair<Verdict, Report> judged_report(const Scenario& scenario, const Recording& recording,
                                         const std::function<void(double share)>& progress) {
  constexpr double judged = 0.3;  // of the work
  const auto part = [&](double from, double to) {
    return progress ? [&progress, from, to](double share) { progress(from + share * (to - from)); }
                    : std::function<void(double)>();
  };
  Verdict verdict = verdict_of(scenario, recording, part(0.0, judged));
  Report report = experiment_report(scenario, recording, verdict, part(judged, 1.0));
  return {std::move(verdict), std::move(report)};
}

}  // namespace flinch
