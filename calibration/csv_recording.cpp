#include "calibration/csv_recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "calibration/csv_table.h"
#include "calibration/hdf5_table.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/scenario/scenario.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/quantity_units.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"

namespace flinch {
namespace {

constexpr double most_gaps = 100'000.0;  // periods without a row, of the smallest log

/// What a column can be.
struct Target {
  const char* name;
  Unit unit;
  int entries;
};

std::vector<Target> targets_of(const ParallelRobot& robot) {
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  return {{"joints.active", turns ? unit::rad : unit::m, robot.drives()},
          {"joints.passive", unit::rad, robot.passive_joints()},
          {"drives.current", unit::A, robot.drives()},
          {"imu.angular_velocity", unit::rad_per_s, 3},
          {"imu.specific_force", unit::m_per_s2, 3},
          {"force_torque.force", unit::N, 3},
          {"force_torque.moment", unit::Nm, 3}};
}

/// A column of the file and what it is.
struct Column {
  std::string name;
  std::string target;
  int entry = 0;
  double scale = 1.0;    ///< to SI, with the sign
  double offset = 0.0;   ///< SI
  bool in_body = false;  ///< a force in the axes of the body on which the instrument sits
};

struct Mapping {
  std::filesystem::path log;
  bool is_hdf5 = false;
  std::filesystem::path scenario;
  std::string separator = ",";
  Time period = 1ms;
  std::string time_column;
  double time_scale = 1.0;
  std::vector<Column> columns;
};

/// How many of the SI unit one of the unit that is written there is; a problem is noted.
double scale_of(ConfigReader& reader, const std::string& written, const Unit& si) {
  std::vector<std::string> known;
  for (const KeyUnit& each : key_units(si)) {
    if (each.key == written) return each.to_si(1.0);
    known.emplace_back(each.key);
  }
  reader.problem("unit",
                 "is '" + written + "', which is no unit of this quantity" + did_you_mean(written, known));
  return 1.0;
}

Column read_column(ConfigReader& reader, const ParallelRobot& robot) {
  Column column;
  std::string written, frame = "base";
  int sign = 1;
  double offset = 0.0;
  reader.required().text("column", column.name);
  reader.required().text("signal", column.target);
  reader.required().text("unit", written);
  reader.integer("entry", column.entry, 0, 5);
  reader.integer("sign", sign, -1, 1);
  reader.number("offset", unit::none, offset);
  reader.text("frame", frame);
  std::vector<std::string> known;
  for (const Target& target : targets_of(robot)) {
    known.emplace_back(target.name);
    if (target.name != column.target) continue;
    column.scale = scale_of(reader, written, target.unit);
    if (column.entry >= target.entries)
      reader.problem("entry", "is " + std::to_string(column.entry) + "; the signal has " +
                                  std::to_string(target.entries) + " entries, counted from 0");
  }
  if (std::find(known.begin(), known.end(), column.target) == known.end())
    reader.problem("signal",
                   "is '" + column.target + "', which is none" + did_you_mean(column.target, known));
  if (sign == 0) reader.problem("sign", "is 0; it must be 1 or -1");
  if (frame != "base" && frame != "body")
    reader.problem("frame", "is '" + frame + "'; it must be base or body");
  column.in_body = frame == "body";
  column.offset = column.scale * offset;
  column.scale *= sign;
  return column;
}

Mapping read_mapping(const std::filesystem::path& file, std::optional<Scenario>& scenario) {
  Mapping mapping;
  ConfigReader reader = ConfigReader::open(file);
  mapping.is_hdf5 = reader.one_of({"csv", "hdf5"}) == "hdf5";
  reader.required().file(mapping.is_hdf5 ? "hdf5" : "csv", mapping.log);
  reader.required().file("scenario", mapping.scenario);
  reader.text("separator", mapping.separator);
  reader.duration("period", mapping.period, between(1e-5, 1.0));
  ConfigReader time = reader.required().section("time");
  std::string written = "s";
  time.required().text("column", mapping.time_column);
  time.text("unit", written);
  mapping.time_scale = scale_of(time, written, unit::s);
  try {
    if (!mapping.scenario.empty()) scenario = read_scenario(mapping.scenario);
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
  }
  for (ConfigReader& column : reader.sections("columns")) {
    if (scenario) {
      mapping.columns.push_back(read_column(column, *scenario->robot.robot));
    } else {
      column.leave_rest_unread();
    }
  }
  if (mapping.separator.size() != 1) reader.problem("separator", "must be one character");
  reader.finish();
  return mapping;
}

/// All columns of one signal, interpolated to the period of the recording.
class Log {
 public:
  Log(const Mapping& mapping, const CsvTable& table) : mapping_(mapping), table_(table) {
    const Eigen::VectorXd raw = table.values.col(table.find(mapping.time_column));
    for (Eigen::Index k = 0; k < raw.size(); ++k) {
      time_.push_back(mapping.time_scale * raw[k]);
      if (k > 0 && time_[static_cast<std::size_t>(k)] <= time_[static_cast<std::size_t>(k) - 1]) {
        throw SetupError(mapping.log.string() + ":" + std::to_string(k + table.first_row) + ": column '" +
                         mapping.time_column + "' does not grow");
      }
    }
    if (time_.size() < 2) throw SetupError(mapping.log.string() + ": there are fewer than two rows");
    const double periods = (time_.back() - time_.front()) / to_seconds(mapping.period);
    // Rows that are further apart than three periods leave nothing valid between them.
    if (!(periods < 3.0 * static_cast<double>(time_.size()) + most_gaps)) {
      throw SetupError(mapping.log.string() + ": column '" + mapping.time_column + "' passes through " +
                       std::to_string(periods) + " periods of the recording in " +
                       std::to_string(time_.size()) + " rows; check the unit of the time, or 'period'");
    }
    samples_ = 1 + static_cast<std::size_t>(periods + 1e-6);
    std::size_t row = 0;
    for (std::size_t k = 0; k < samples_; ++k) {
      const double now = time_.front() + static_cast<double>(k) * to_seconds(mapping.period);
      while (row + 2 < time_.size() && time_[row + 1] < now) ++row;
      row_.push_back(row);
      share_.push_back(std::clamp((now - time_[row]) / (time_[row + 1] - time_[row]), 0.0, 1.0));
      near_.push_back(time_[row + 1] - time_[row] <= 3.0 * to_seconds(mapping.period) ? 1 : 0);
    }
  }

  std::size_t samples() const { return samples_; }
  Time time(std::size_t k) const { return static_cast<Time::rep>(k) * mapping_.period; }
  bool is_near(std::size_t k) const { return near_[k] == 1; }

  bool has(const std::string& target) const {
    return std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                       [&](const Column& column) { return column.target == target; });
  }
  bool is_in_body(const std::string& target) const {
    return std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                       [&](const Column& column) { return column.target == target && column.in_body; });
  }

  /// The entries of a target at a sample; those without a column stay zero.
  Eigen::VectorXd at(const std::string& target, int entries, std::size_t k) const {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(entries);
    for (const Column& column : mapping_.columns) {
      if (column.target != target) continue;
      const int index = table_.find(column.name);
      const auto row = static_cast<Eigen::Index>(row_[k]);
      const double raw =
          (1.0 - share_[k]) * table_.values(row, index) + share_[k] * table_.values(row + 1, index);
      values[column.entry] = column.scale * raw + column.offset;
    }
    return values;
  }

  /// Throws SetupError unless each entry of the target has a column.
  void need_all(const std::string& target, int entries) const {
    for (int entry = 0; entry < entries; ++entry) {
      const bool found =
          std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                      [&](const Column& column) { return column.target == target && column.entry == entry; });
      if (!found)
        throw SetupError(mapping_.log.string() + ": no column is mapped to entry " + std::to_string(entry) +
                         " of " + target);
    }
  }

 private:
  const Mapping& mapping_;
  const CsvTable& table_;
  std::vector<double> time_;
  std::size_t samples_ = 0;
  std::vector<std::size_t> row_;
  std::vector<double> share_;
  std::vector<char> near_;
};

template <class T, class Make>
void add_signal(const char* path, const Log& log, const ParallelRobot& robot, Make&& make,
                Recording& recording) {
  Signal signal{path, row_layout<T>(), {}};
  const std::map<std::string, std::string> units = quantity_units(robot);
  for (Field& field : signal.layout.fields) {
    if (const auto found = units.find(field.unit); found != units.end()) field.unit = found->second;
  }
  signal.rows.resize(log.samples() * signal.layout.numbers);
  for (std::size_t k = 0; k < log.samples(); ++k) {
    T value{};
    value.acquired = log.time(k);
    value.valid = log.is_near(k);
    make(k, value);
    write_row(value, signal.rows.data() + k * signal.layout.numbers);
  }
  recording.signals.push_back(std::move(signal));
}

/// Axes of the body on which the instrument sits, from the joints at a sample.
Eigen::Matrix3d axes_at(const Scenario& scenario, const Log& log, std::size_t k, Configuration& pose) {
  const ParallelRobot& robot = *scenario.robot.robot;
  const JointVector active = log.at("joints.active", robot.drives(), k);
  const ForwardSolution solution = robot.forward_kinematics(active, pose, robot.home_working_mode());
  if (!solution.converged) return Eigen::Matrix3d::Identity();
  pose = solution.pose;
  int body = 0;
  for (const InstrumentMounting& mounting : scenario.mountings) {
    if (mounting.start <= log.time(k)) body = mounting.body;
  }
  Kinematics at;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), at);
  const int directions = robot.space_dimension();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const auto place = [&](const Eigen::Vector3d& point) {
    Eigen::Vector3d full = Eigen::Vector3d::Zero();
    full.head(directions) = robot.point_on_body(at, BodyId::from_index(body), point.head(directions));
    return full;
  };
  for (int i = 0; i < directions; ++i)
    axes.col(i) = place(Eigen::Vector3d::Unit(i)) - place(Eigen::Vector3d::Zero());
  return axes;
}

void add_readings(const Scenario& scenario, const Log& log, Recording& recording) {
  const ParallelRobot& robot = *scenario.robot.robot;
  log.need_all("joints.active", robot.drives());
  const bool passive = log.has("joints.passive");
  if (passive) log.need_all("joints.passive", robot.passive_joints());
  add_signal<JointReading>(
      "joints", log, robot,
      [&](std::size_t k, JointReading& reading) {
        reading.active = log.at("joints.active", robot.drives(), k);
        reading.passive = log.at("joints.passive", robot.passive_joints(), k);
        reading.passive_valid = reading.valid && passive;
      },
      recording);
  if (log.has("drives.current")) {
    log.need_all("drives.current", robot.drives());
    add_signal<DriveReading>(
        "drives", log, robot,
        [&](std::size_t k, DriveReading& reading) {
          reading.current = log.at("drives.current", robot.drives(), k);
        },
        recording);
  }
  if (log.has("imu.angular_velocity") || log.has("imu.specific_force")) {
    log.need_all("imu.angular_velocity", 3);
    log.need_all("imu.specific_force", 3);
    add_signal<ImuReading>(
        "imu", log, robot,
        [&](std::size_t k, ImuReading& reading) {
          reading.angular_velocity = log.at("imu.angular_velocity", 3, k);
          reading.specific_force = log.at("imu.specific_force", 3, k);
        },
        recording);
  }
  if (log.has("force_torque.force")) {
    const bool in_body = log.is_in_body("force_torque.force");
    Configuration pose = robot.home_pose();
    add_signal<ForceTorqueReading>(
        "force_torque", log, robot,
        [&](std::size_t k, ForceTorqueReading& reading) {
          const Eigen::Matrix3d axes =
              in_body ? axes_at(scenario, log, k, pose) : Eigen::Matrix3d::Identity();
          reading.force_in_base = axes * Eigen::Vector3d(log.at("force_torque.force", 3, k));
          reading.moment_in_base = axes * Eigen::Vector3d(log.at("force_torque.moment", 3, k));
        },
        recording);
  }
}

}  // namespace

Recording read_csv_recording(const std::filesystem::path& file,
                             const std::map<std::string, std::string>& provenance) {
  std::optional<Scenario> scenario;
  const Mapping mapping = read_mapping(file, scenario);
  std::vector<std::string> wanted = {mapping.time_column};
  for (const Column& column : mapping.columns) wanted.push_back(column.name);
  const CsvTable table = mapping.is_hdf5 ? read_hdf5_table(mapping.log, wanted)
                                         : read_csv(mapping.log, mapping.separator.front(), wanted);
  const Log log(mapping, table);
  Recording recording;
  recording.period = mapping.period;
  for (std::size_t k = 0; k < log.samples(); ++k) recording.time_ns.push_back(log.time(k).count());
  recording.attributes = recorded_attributes(*scenario, provenance);
  recording.attributes["imported.from"] = mapping.log.filename().string();
  add_readings(*scenario, log, recording);
  return recording;
}

}  // namespace flinch
