#include "calibration/csv_recording.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include "calibration/csv_table.h"
#include "calibration/hdf5_table.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/scenario/scenario.h"
#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
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
  require_kind(reader, FileKind::mapping);
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

/// A sample of the recording between two rows of the log.
struct Between {
  Time time{};
  Eigen::Index row = 0;  ///< the first of the two
  double share = 0.0;    ///< of the second
  bool near = false;     ///< whether they are no further apart than three periods
};

/// The log, interpolated to the period of the recording.
class Log {
 public:
  explicit Log(Mapping mapping) : mapping_(std::move(mapping)) {
    std::vector<std::string> wanted = {mapping_.time_column};
    for (const Column& column : mapping_.columns) wanted.push_back(column.name);
    table_ = mapping_.is_hdf5 ? read_hdf5_table(mapping_.log, each_once(wanted))
                              : read_csv(mapping_.log, mapping_.separator.front(), wanted);
    for (const Column& column : mapping_.columns) index_.push_back(table_.find(column.name));
    time_ = table_.find(mapping_.time_column);
    check_times();
  }

  std::size_t samples() const { return samples_; }

  bool has(const std::string& target) const {
    return std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                       [&](const Column& column) { return column.target == target; });
  }
  bool is_in_body(const std::string& target) const {
    return std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                       [&](const Column& column) { return column.target == target && column.in_body; });
  }

  /// Where the samples first ... first + count lie.
  std::vector<Between> between(std::size_t first, std::size_t count) const {
    std::vector<Between> places(count);
    const Eigen::Index last = table_.values.rows() - 2;
    Eigen::Index row = 0;
    for (auto step = static_cast<Eigen::Index>(std::bit_floor(static_cast<std::size_t>(last) + 1)); step > 0;
         step /= 2)
      if (row + step <= last && seconds(row + step) < instant(first)) row += step;
    for (std::size_t i = 0; i < count; ++i) {
      const double now = instant(first + i);
      while (row < last && seconds(row + 1) < now) ++row;
      const double gap = seconds(row + 1) - seconds(row);
      places[i] = {.time = static_cast<Time::rep>(first + i) * mapping_.period,
                   .row = row,
                   .share = std::clamp((now - seconds(row)) / gap, 0.0, 1.0),
                   .near = gap <= 3.0 * to_seconds(mapping_.period)};
    }
    return places;
  }

  /// The entries of a target at a sample; those without a column stay zero.
  Eigen::VectorXd at(const std::string& target, int entries, const Between& place) const {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(entries);
    for (std::size_t i = 0; i < index_.size(); ++i) {
      const Column& column = mapping_.columns[i];
      if (column.target != target) continue;
      const double raw = (1.0 - place.share) * table_.values(place.row, index_[i]) +
                         place.share * table_.values(place.row + 1, index_[i]);
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
  /// Time of a row, and of a sample [s].
  double seconds(Eigen::Index row) const { return mapping_.time_scale * table_.values(row, time_); }
  double instant(std::size_t sample) const {
    return seconds(0) + static_cast<double>(sample) * to_seconds(mapping_.period);
  }

  void check_times() {
    const Eigen::Index rows = table_.values.rows();
    for (Eigen::Index k = 1; k < rows; ++k) {
      if (seconds(k) > seconds(k - 1)) continue;
      throw SetupError(mapping_.log.string() + ":" + std::to_string(k + table_.first_row) + ": column '" +
                       mapping_.time_column + "' does not grow");
    }
    if (rows < 2) throw SetupError(mapping_.log.string() + ": there are fewer than two rows");
    const double periods = (seconds(rows - 1) - seconds(0)) / to_seconds(mapping_.period);
    // Rows that are further apart than three periods leave nothing valid between them.
    if (!(periods < 3.0 * static_cast<double>(rows) + most_gaps)) {
      throw SetupError(mapping_.log.string() + ": column '" + mapping_.time_column + "' passes through " +
                       std::to_string(periods) + " periods of the recording in " + std::to_string(rows) +
                       " rows; check the unit of the time, or 'period'");
    }
    samples_ = 1 + static_cast<std::size_t>(periods + 1e-6);
  }

  Mapping mapping_;
  CsvTable table_;
  std::vector<int> index_;  ///< in the table, of each column of the mapping
  int time_ = 0;            ///< likewise
  std::size_t samples_ = 0;
};

/// The axes of the body on which the instrument sits, from the joints.
class InstrumentAxes {
 public:
  /// The forward kinematics of a sample begins with the pose of the one before, so those of the first samples
  /// of blocks are kept.
  InstrumentAxes(const Scenario& scenario, const Log& log)
      : robot_(scenario.robot.robot), mountings_(scenario.mountings) {
    Configuration pose = robot_->home_pose();
    for (std::size_t first = 0; first < log.samples(); first += Recording::block) {
      begin_.push_back(pose);
      for (const Between& place : log.between(first, std::min(Recording::block, log.samples() - first)))
        axes_at(log, place, pose);
    }
  }

  /// Axes at each of these samples, as columns in the base frame.
  std::vector<Eigen::Matrix3d> read(const Log& log, std::size_t first, std::size_t count) const {
    const std::size_t block = first / Recording::block, before = first - block * Recording::block;
    Configuration pose = begin_[block];
    std::vector<Eigen::Matrix3d> axes;
    for (const Between& place : log.between(first - before, before + count))
      axes.push_back(axes_at(log, place, pose));
    axes.erase(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(before));
    return axes;
  }

 private:
  Eigen::Matrix3d axes_at(const Log& log, const Between& place, Configuration& pose) const {
    const JointVector active = log.at("joints.active", robot_->drives(), place);
    const ForwardSolution solution = robot_->forward_kinematics(active, pose, robot_->home_working_mode());
    if (!solution.converged) return Eigen::Matrix3d::Identity();
    pose = solution.pose;
    int body = 0;
    for (const InstrumentMounting& mounting : mountings_) {
      if (mounting.start <= place.time) body = mounting.body;
    }
    Kinematics at;
    robot_->kinematics(pose, PlatformVector::Zero(robot_->dof()), at);
    const int directions = robot_->space_dimension();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    const auto point = [&](const Eigen::Vector3d& in_body) {
      Eigen::Vector3d full = Eigen::Vector3d::Zero();
      full.head(directions) = robot_->point_on_body(at, BodyId::from_index(body), in_body.head(directions));
      return full;
    };
    for (int i = 0; i < directions; ++i)
      axes.col(i) = point(Eigen::Vector3d::Unit(i)) - point(Eigen::Vector3d::Zero());
    return axes;
  }

  std::shared_ptr<const ParallelRobot> robot_;
  std::vector<InstrumentMounting> mountings_;
  std::vector<Configuration> begin_;
};

/// The rows of the recording, each interpolated when it is read: only the log is in memory.
class ImportedRows final : public RowSource {
 public:
  /// Says in `recording` what there is.
  ImportedRows(Mapping mapping, const Scenario& scenario, Recording& recording)
      : log_(std::move(mapping)), robot_(scenario.robot.robot) {
    add_joints(recording);
    add_drives(recording);
    add_imu(recording);
    add_force_torque(scenario, recording);
  }

  std::size_t samples() const { return log_.samples(); }

  void read(const std::string& path, std::size_t first, std::size_t count,
            internal::Number* rows) const override {
    writers_.at(path)(first, count, rows);
  }

 private:
  using Writer = std::function<void(std::size_t first, std::size_t count, internal::Number* rows)>;

  /// A signal of T. `prepare` is told which samples are read and returns what fills one of them, from its
  /// number among these and its place in the log.
  template <class T, class Prepare>
  void add(const char* path, Recording& recording, Prepare prepare) {
    Signal signal{path, row_layout<T>(), {}};
    const std::map<std::string, std::string> units = quantity_units(*robot_);
    for (Field& field : signal.layout.fields) {
      if (const auto found = units.find(field.unit); found != units.end()) field.unit = found->second;
    }
    const std::size_t numbers = signal.layout.numbers;
    recording.signals.push_back(std::move(signal));
    writers_[path] = [this, prepare, numbers](std::size_t first, std::size_t count, internal::Number* rows) {
      const auto make = prepare(first, count);
      const std::vector<Between> places = log_.between(first, count);
      for (std::size_t i = 0; i < count; ++i) {
        T value{};
        value.acquired = places[i].time;
        value.valid = places[i].near;
        make(i, places[i], value);
        write_row(value, rows + i * numbers);
      }
    };
  }

  /// The same where no sample needs another.
  template <class T, class Make>
  void add_each(const char* path, Recording& recording, Make make) {
    add<T>(path, recording, [make](std::size_t, std::size_t) {
      return [make](std::size_t, const Between& place, T& value) { make(place, value); };
    });
  }

  void add_joints(Recording& recording) {
    log_.need_all("joints.active", robot_->drives());
    const bool passive = log_.has("joints.passive");
    if (passive) log_.need_all("joints.passive", robot_->passive_joints());
    add_each<JointReading>("joints", recording, [this, passive](const Between& at, JointReading& reading) {
      reading.active = log_.at("joints.active", robot_->drives(), at);
      reading.passive = log_.at("joints.passive", robot_->passive_joints(), at);
      reading.passive_valid = reading.valid && passive;
    });
  }

  void add_drives(Recording& recording) {
    if (!log_.has("drives.current")) return;
    log_.need_all("drives.current", robot_->drives());
    add_each<DriveReading>("drives", recording, [this](const Between& at, DriveReading& reading) {
      reading.current = log_.at("drives.current", robot_->drives(), at);
    });
  }

  void add_imu(Recording& recording) {
    if (!log_.has("imu.angular_velocity") && !log_.has("imu.specific_force")) return;
    log_.need_all("imu.angular_velocity", 3);
    log_.need_all("imu.specific_force", 3);
    add_each<ImuReading>("imu", recording, [this](const Between& at, ImuReading& reading) {
      reading.angular_velocity = log_.at("imu.angular_velocity", 3, at);
      reading.specific_force = log_.at("imu.specific_force", 3, at);
    });
  }

  void add_force_torque(const Scenario& scenario, Recording& recording) {
    if (!log_.has("force_torque.force")) return;
    if (log_.is_in_body("force_torque.force")) axes_.emplace(scenario, log_);
    add<ForceTorqueReading>("force_torque", recording, [this](std::size_t first, std::size_t count) {
      std::vector<Eigen::Matrix3d> axes(axes_ ? 0 : count, Eigen::Matrix3d::Identity());
      if (axes_) axes = axes_->read(log_, first, count);
      return [this, axes](std::size_t i, const Between& at, ForceTorqueReading& reading) {
        reading.force_in_base = axes[i] * Eigen::Vector3d(log_.at("force_torque.force", 3, at));
        reading.moment_in_base = axes[i] * Eigen::Vector3d(log_.at("force_torque.moment", 3, at));
      };
    });
  }

  Log log_;
  std::shared_ptr<const ParallelRobot> robot_;
  std::optional<InstrumentAxes> axes_;
  std::map<std::string, Writer> writers_;
};

}  // namespace

Recording read_csv_recording(const std::filesystem::path& file,
                             const std::map<std::string, std::string>& provenance) {
  std::optional<Scenario> scenario;
  Mapping mapping = read_mapping(file, scenario);
  const std::string imported_from = mapping.log.filename().string();
  Recording recording;
  recording.period = mapping.period;
  const auto rows = std::make_shared<const ImportedRows>(std::move(mapping), *scenario, recording);
  recording.time_ns.resize(rows->samples());
  for (std::size_t k = 0; k < rows->samples(); ++k)
    recording.time_ns[k] = (static_cast<Time::rep>(k) * recording.period).count();
  recording.source = rows;
  recording.attributes = recorded_attributes(*scenario, provenance);
  recording.attributes["imported.from"] = imported_from;
  return recording;
}

std::vector<std::filesystem::path> files_of_mapping(const std::filesystem::path& file) {
  std::optional<Scenario> scenario;
  const Mapping mapping = read_mapping(file, scenario);
  return {file, mapping.log, mapping.scenario};
}

}  // namespace flinch
