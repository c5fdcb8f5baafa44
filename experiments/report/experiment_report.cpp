#include "experiments/report/experiment_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "experiments/recorded/robot_as_drawn.h"
#include "experiments/report/drawn_robot.h"
#include "experiments/report/page_samples.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using Column = std::vector<double>;

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
  const auto place = static_cast<std::size_t>(contact.obstacle);
  return place < obstacles.size() ? obstacles[place].name : "obstacle";
}

ReportContact report_contact(const ContactVerdict& contact, const std::vector<ScenarioObstacle>& obstacles) {
  ReportContact row;
  row.body = spoken(contact.body);
  row.object = object_of(contact, obstacles);
  row.start = contact.onset;
  row.detected = contact.detected;
  row.removed = contact.removed;
  row.speed = contact.speed;
  row.peak_force = contact.peak_force;
  row.peak_time = contact.peak_time;
  row.force_limit = contact.limit;
  row.limit_name = "ISO/TS 15066, " + contact.limit_name + ", hand, as quoted in [SafePR]";
  row.within_limit = contact.within_limit;
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

constexpr std::array axes{"x", "y", "z"};

/// The components of a recorded vector.
std::vector<Column> components(const Recording& recording, const std::string& path, const std::string& field,
                               int count, int first = 0) {
  std::vector<Column> columns;
  for (int i = first; i < first + count; ++i) columns.push_back(recording.column(path, field, i));
  return columns;
}

Column magnitude(const std::vector<Column>& vector) {
  Column result(vector.empty() ? 0 : vector.front().size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    for (const Column& component : vector) result[k] = std::hypot(result[k], component[k]);
  }
  return result;
}

/// `column` where `flag` is set, "no data" elsewhere.
Column where(const Column& flag, Column column) {
  for (std::size_t k = 0; k < column.size(); ++k) {
    if (flag[k] == 0.0 || std::isnan(flag[k])) column[k] = std::nan("");
  }
  return column;
}

void add_vector(const std::string& prefix, std::vector<Column> components, Report& report) {
  for (std::size_t i = 0; i < components.size(); ++i)
    report.columns[prefix + axes[i]] = std::move(components[i]);
}

/// A contact point is only shown while its body is touched.
void add_touch(const Recording& recording, const std::string& field, const std::string& name, int dimension,
               Report& report) {
  Column touched = recording.column("contact", field + ".body");
  for (double& body : touched) body = body >= 0.0 ? 1.0 : 0.0;
  const auto shown = [&](const std::string& part) {
    std::vector<Column> columns = components(recording, "contact", field + part, dimension);
    for (Column& column : columns) column = where(touched, std::move(column));
    return columns;
  };
  add_vector(name + "_", shown(".point_in_base"), report);
  add_vector(name + "_force_", shown(".force_in_base"), report);
}

/// The pose at a sample, out of the columns of a recorded one.
Configuration pose_at(const std::vector<Column>& columns, std::size_t sample) {
  Configuration pose(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) pose[static_cast<Eigen::Index>(i)] = columns[i][sample];
  return pose;
}

void add_pose(const ConfigurationSpace& space, std::vector<Column> pose, Report& report) {
  for (int i = 0; i < space.translations(); ++i) {
    report.columns[std::string("pose_") + axes[static_cast<std::size_t>(i)]] =
        std::move(pose[static_cast<std::size_t>(i)]);
  }
  constexpr std::array quaternion{"pose_qw", "pose_qx", "pose_qy", "pose_qz"};
  for (std::size_t i = static_cast<std::size_t>(space.translations()); i < pose.size(); ++i) {
    const std::size_t part = i - static_cast<std::size_t>(space.translations());
    report.columns[space.rotations() == 1 ? "pose_phi" : quaternion[part]] = std::move(pose[i]);
  }
}

/// As they truly were, or as the controller took them to be.
void add_motion(const ParallelRobot& robot, const Recording& recording, Witness witness, Report& report) {
  const bool simulated = witness == Witness::truth;
  const std::string path = simulated ? "truth" : "motion";
  const ConfigurationSpace& space = robot.space();
  const std::vector<Column> pose = components(recording, path, "pose", space.stored());
  const std::vector<Column> target = components(recording, "reference", "pose", space.stored());
  Column distance(pose.front().size()), angle(distance.size());
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const PlatformVector error = space.difference(pose_at(pose, k), pose_at(target, k));
    distance[k] = error.head(space.translations()).norm();
    angle[k] = error.tail(space.rotations()).norm();
  }
  const Column followed = recording.column("reference", "valid");
  report.columns["position_error"] = where(followed, std::move(distance));
  if (space.rotations() > 0) report.columns["orientation_error"] = where(followed, std::move(angle));
  report.columns["speed"] = magnitude(components(recording, path, "velocity", space.translations()));
  add_pose(space, pose, report);
  add_elbows(robot, report);
  for (int drive = 0; drive < robot.drives(); ++drive) {
    const std::string number = std::to_string(drive + 1);
    if (simulated)
      report.columns["torque_applied_" + number] = recording.column("truth", "drive_torque", drive);
    report.columns["torque_commanded_" + number] = where(recording.column("torque_command", "valid"),
                                                         recording.column("torque_command", "torque", drive));
  }
  const Column measured = recording.column("measures", "valid");
  report.columns["sigma_kappa"] = where(measured, recording.column("measures", "sigma_kappa"));
  report.columns["sigma_sc"] = where(measured, recording.column("measures", "sigma_sc"));
}

void add_wrench(const ConfigurationSpace& space, const std::string& name, std::vector<Column> wrench,
                Report& report) {
  const auto moments = wrench.begin() + space.translations();
  add_vector(name + "_force_", {wrench.begin(), moments}, report);
  if (space.rotations() == 1) report.columns[name + "_moment"] = *moments;
  if (space.rotations() == 3) add_vector(name + "_moment_", {moments, wrench.end()}, report);
}

void add_forces(const ParallelRobot& robot, const Recording& recording, Witness witness, Report& report) {
  std::vector<Column> estimate = components(recording, "wrench", "wrench_in_base", robot.dof());
  const Column estimated = recording.column("wrench", "valid");
  for (Column& column : estimate) column = where(estimated, std::move(column));
  add_wrench(robot.space(), "estimated", std::move(estimate), report);
  if (witness != Witness::truth) return;
  add_wrench(robot.space(), "external", components(recording, "truth", "wrench_in_base", robot.dof()),
             report);
  add_touch(recording, "strongest", "contact_1", robot.space_dimension(), report);
  add_touch(recording, "second", "contact_2", robot.space_dimension(), report);
}

ReportLane lane(const Recording& recording, std::string name, const std::string& path,
                const std::string& field, std::vector<std::string> states) {
  ReportLane result{std::move(name), std::move(states), {}};
  for (const double state : recording.column(path, field)) result.state.push_back(static_cast<int>(state));
  return result;
}

std::vector<ReportLane> lanes(const Recording& recording) {
  ReportLane mode = lane(recording, "mode", "reaction", "mode",
                         {"nominal", "stopped", "react", "hold", "zero-g", "recover"});
  for (int& state : mode.state) {  // the page's quiet state comes first: nominal before stopped
    if (state < 2) state = 1 - state;
  }
  return {lane(recording, "detector", "detection", "level", {"quiet", "contact", "hard contact"}), mode,
          lane(recording, "torque gate", "gate", "phase", {"waiting", "open", "closed", "recovering"})};
}

/// The force of the hardest contact, and whether it counts as one: as for the verdict, so that the lane ends
/// when the verdict says that the contact was removed.
void add_contact(const ParallelRobot& robot, const Recording& recording, Report& report) {
  const RecordedRun run(recording, robot.space());
  if (run.witness() == Witness::none) return;
  Column force;
  ReportLane touching{"contact", {"free", "touching"}, {}};
  for (std::size_t k = 0; k < run.size(); ++k) {
    const RunSample now = run[k];
    const int counts = now.load() > 1.0 ? 1 : 0;
    force.push_back(now.force());
    touching.state.push_back(std::isnan(now.load()) ? -1 : counts);
  }
  report.columns["contact_force"] = std::move(force);
  report.lanes.insert(report.lanes.begin(), std::move(touching));
}

std::string caveat(Witness witness) {
  const std::string common =
      " flinch is not a certified safety function; take force limits from the standard itself.";
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
  const std::size_t together = samples_in_one(recording);
  if (together == 1) return "";
  return fmt::format(
      " The recording is long: of {} samples each the page shows one, that with the hardest contact.",
      together);
}

std::vector<ReportBound> bounds(const Scenario& scenario, const Verdict& verdict) {
  const ContactDetectorSettings detector =
      scenario.control.detector_of(followed_name(scenario.control.stages.estimators));
  std::vector<ReportBound> lines;
  for (const double sign : {1.0, -1.0}) {
    lines.push_back({"force", "reaction threshold", sign * detector.reaction.force});
    lines.push_back({"force", "hard threshold", sign * detector.hard.force});
    lines.push_back({"moment", "reaction threshold", sign * detector.reaction.moment});
    lines.push_back({"moment", "hard threshold", sign * detector.hard.moment});
  }
  for (const ContactVerdict& contact : verdict.contacts) {
    lines.push_back({"contact_force", contact.limit_name + " limit", contact.limit});
  }
  lines.push_back({"sigma_sc", "torque gate closes", scenario.robot.limits.min_self_collision_distance});
  return lines;
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

Report experiment_report(const Scenario& scenario, const Recording& recording, const Verdict& verdict) {
  Report report;
  report.kind = verdict.witness == Witness::truth ? "simulated experiment" : "experiment on a robot";
  report.title = scenario.title;
  report.subtitle = scenario.description;
  report.note = caveat(verdict.witness) + thinning(recording);
  report.good = verdict.good();
  report.reasons = verdict.failures;
  report.remarks = verdict.remarks;
  report.fault = verdict.fault;
  report.contacts_known = verdict.witness != Witness::none;
  for (const ContactVerdict& contact : verdict.contacts)
    report.contacts.push_back(report_contact(contact, scenario.obstacles));
  report.measures = measures(verdict, scenario.expected);
  const ParallelRobot& robot = *scenario.robot.robot;
  report.robot = drawn_robot(robot);
  report.drive_unit = robot.drive_kind(0) == DriveKind::revolute ? "Nm" : "N";
  for (const ScenarioObstacle& obstacle : scenario.obstacles) {
    report.obstacles.push_back(drawn_obstacle(obstacle.name, obstacle.shape, obstacle.position_in_base));
  }
  const Recording shown = page_samples(recording);
  report.period = to_seconds(shown.period);
  if (!recording.time_ns.empty()) report.start = 1e-9 * static_cast<double>(recording.time_ns.front());
  add_motion(robot, shown, verdict.witness, report);
  add_forces(robot, shown, verdict.witness, report);
  report.lanes = lanes(shown);
  add_contact(robot, shown, report);
  report.bounds = bounds(scenario, verdict);
  report.parameters = scenario_parameters(scenario);
  for (ReportParameter& row : parameters("robot", scenario.robot.values))
    report.parameters.push_back(std::move(row));
  for (ReportParameter& row : drawn_parameters(recording)) report.parameters.push_back(std::move(row));
  report.provenance = provenance(recording);
  report.texts = {{"Scenario " + scenario.file.filename().string(), scenario.text},
                  {"Robot " + scenario.robot_file.filename().string(), scenario.robot_text}};
  return report;
}

}  // namespace flinch
