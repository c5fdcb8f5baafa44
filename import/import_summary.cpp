#include "import/import_summary.h"

#include <algorithm>
#include <cmath>

#include "systems/robot/kinematic_causes.h"
#include "systems/robot/kinematic_check.h"

namespace flinch {
namespace {

SignalSummary signal_summary(const MappedLog& log, const std::string& name) {
  SignalSummary summary;
  summary.name = name;
  int entries = 0;
  for (const MappedColumn& column : log.mapping().columns) {
    if (column.signal != name) continue;
    summary.entries.push_back({column.column, column.entry, INFINITY, -INFINITY});
    entries = std::max(entries, column.entry + 1);
  }
  MappedLog::Cursor cursor(log, name, entries);
  std::size_t valid = 0;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    const Eigen::VectorXd& values = cursor.at(k);
    valid += values.allFinite() ? 1 : 0;
    for (SignalSummary::Entry& entry : summary.entries) {
      const double value = values[entry.entry];
      if (!std::isfinite(value)) continue;
      entry.least = std::min(entry.least, value);
      entry.most = std::max(entry.most, value);
    }
  }
  summary.valid_fraction = static_cast<double>(valid) / static_cast<double>(log.samples());
  return summary;
}

/// Whether the robot can stand as the log says, and why not.
std::vector<std::string> warnings_about_poses(const MappedLog& log) {
  constexpr std::size_t most_rows = 1000;
  const ParallelRobot& robot = *log.mapping().scenario.robot.robot;
  MappedLog::Cursor cursor(log, "joints.active", robot.drives());
  std::vector<JointVector> rows;
  for (std::size_t k = 0; k < log.samples(); k += std::max<std::size_t>(1, log.samples() / most_rows)) {
    const Eigen::VectorXd& values = cursor.at(k);
    if (values.allFinite()) rows.emplace_back(values);
  }
  const double share = check_kinematics(robot, rows).valid_fraction;
  if (rows.empty() || share >= 0.9) return {};
  return {"the robot can stand as its drives say in " + std::to_string(std::lround(100.0 * share)) +
          " % of the rows only: " +
          told_kinematic_causes(robot, rows, "the log is of another robot, or its columns are others")};
}

}  // namespace

ImportSummary summary_of(const MappedLog& log) {
  ImportSummary summary{.rows = log.rows(),
                        .samples = log.samples(),
                        .rate = log.rate().rate(),
                        .jitter = log.rate().jitter,
                        .gaps = log.rate().gaps,
                        .repeated = log.repeated(),
                        .seconds = to_seconds(log.period()) * static_cast<double>(log.samples()),
                        .signals = {},
                        .unused = log.unused(),
                        .computed = log.computed(),
                        .warnings = log.warnings()};
  for (const LogSignal& signal : log_signals(*log.mapping().scenario.robot.robot)) {
    if (log.has(signal.name)) summary.signals.push_back(signal_summary(log, signal.name));
  }
  for (const SignalSummary& signal : summary.signals) {
    if (signal.valid_fraction < 0.5)
      summary.warnings.push_back(signal.name + " is valid in " +
                                 std::to_string(std::lround(100.0 * signal.valid_fraction)) +
                                 " % of the samples only");
  }
  for (const std::string& warning : warnings_about_poses(log)) summary.warnings.push_back(warning);
  return summary;
}

}  // namespace flinch
