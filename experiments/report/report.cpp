#include "experiments/report/report.h"

#include <algorithm>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Names = std::vector<std::string>;

const Names charts{"contact_force",
                   "force",
                   "moment",
                   "force_by_estimator",
                   "moment_by_estimator",
                   "speed",
                   "position_error",
                   "orientation_error",
                   "torque",
                   "sigma_kappa",
                   "sigma_sc",
                   "energy",
                   "energy_rate",
                   "probability",
                   "location_error",
                   "force_error"};
constexpr int most_estimators = 16;

Names column_names() {
  Names names{"pose_x",
              "pose_y",
              "pose_z",
              "pose_phi",
              "pose_qw",
              "pose_qx",
              "pose_qy",
              "pose_qz",
              "speed",
              "position_error",
              "orientation_error",
              "sigma_kappa",
              "sigma_sc",
              "contact_force",
              "sigma_kappa_reference",
              "sigma_sc_reference",
              "location_error",
              "force_error",
              "probability_platform"};
  const auto add = [&names](const std::string& prefix) {
    for (const char* const axis : {"x", "y", "z"}) names.push_back(prefix + axis);
  };
  for (const std::string task : {"sigma_kappa", "sigma_sc", "task_1", "task_2"}) {
    names.push_back("energy_" + task);
    names.push_back("energy_rate_" + task);
  }
  for (const std::string contact : {"contact_1_", "contact_2_"}) {
    add(contact);
    add(contact + "force_");
  }
  for (const std::string wrench : {"external_", "estimated_"}) {
    add(wrench + "force_");
    add(wrench + "moment_");
    names.push_back(wrench + "moment");
  }
  add("isolated_");
  for (int i = 1; i <= most_estimators; ++i) {
    for (const std::string part : {"_force", "_moment"})
      names.push_back("estimator_" + std::to_string(i) + part);
  }
  for (int obstacle = 1; obstacle <= 8; ++obstacle) add("obstacle_" + std::to_string(obstacle) + "_");
  for (int particle = 1; particle <= most_page_particles; ++particle) {
    add("particle_" + std::to_string(particle) + "_");
  }
  for (int leg = 1; leg <= 6; ++leg) {
    for (const std::string what : {"link1", "link2", "clamping"}) {
      names.push_back("probability_leg" + std::to_string(leg) + "_" + what);
    }
    add("elbow_" + std::to_string(leg) + "_");
    for (const std::string torque : {"torque_commanded_", "torque_applied_"}) {
      names.push_back(torque + std::to_string(leg));
    }
  }
  return names;
}

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_length(const std::string& what, size_t length, const Report& report, Names& problems) {
  if (length == report.sample_count()) return;
  problems.push_back("report: " + what + " has " + std::to_string(length) + " samples, others have " +
                     std::to_string(report.sample_count()));
}

void check_columns(const Report& report, Names& problems) {
  const Names known = column_names();
  for (const auto& [name, values] : report.columns) {
    if (!contains(known, name)) {
      problems.push_back("report: the page has no column '" + name + "'" + did_you_mean(name, known));
    }
    check_length("column '" + name + "'", values.size(), report, problems);
  }
}

void check_lanes(const Report& report, Names& problems) {
  for (const ReportLane& lane : report.lanes) {
    check_length("lane '" + lane.name + "'", lane.state.size(), report, problems);
    const auto highest = std::max_element(lane.state.begin(), lane.state.end());
    if (highest == lane.state.end() || *highest < static_cast<int>(lane.states.size())) continue;
    problems.push_back("report: lane '" + lane.name + "' has no name for state " + std::to_string(*highest));
  }
}

void check_bounds(const Report& report, Names& problems) {
  for (const ReportBound& bound : report.bounds) {
    if (contains(charts, bound.chart)) continue;
    problems.push_back("report: bound '" + bound.name + "' is for chart '" + bound.chart +
                       "', which the page has not" + did_you_mean(bound.chart, charts));
  }
}

}  // namespace

size_t Report::sample_count() const {
  if (!columns.empty()) return columns.begin()->second.size();
  return lanes.empty() ? 0 : lanes.front().state.size();
}

void check_report(const Report& report) {
  Names problems;
  check_columns(report, problems);
  check_lanes(report, problems);
  check_bounds(report, problems);
  if (report.sample_count() > 0 && !(report.period > 0.0)) {
    problems.push_back("report: the period of the samples is " + std::to_string(report.period) +
                       " s, it must be positive");
  }
  throw_if_any(std::move(problems));
}

}  // namespace flinch
