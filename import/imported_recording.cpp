#include "import/imported_recording.h"

#include <algorithm>
#include <functional>
#include <optional>

#include "experiments/recorded/recorded_signals.h"
#include "import/instrument_axes.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/quantity_units.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"

namespace flinch {
namespace {

using Cursor = MappedLog::Cursor;

/// Rows of a recording, each made from the log when it is read.
class ImportedRows final : public RowSource {
 public:
  /// Says in `recording` what there is.
  ImportedRows(std::shared_ptr<const MappedLog> log, Recording& recording)
      : log_(std::move(log)), robot_(log_->mapping().scenario.robot.robot) {
    add_joints(recording);
    add_drives(recording);
    add_imu(recording);
    add_force_torque(recording);
  }

  void read(const std::string& path, std::size_t first, std::size_t count,
            internal::Number* rows) const override {
    writers_.at(path)(first, count, rows);
  }

 private:
  using Writer = std::function<void(std::size_t first, std::size_t count, internal::Number* rows)>;

  /// A signal of T. `prepare` is told which samples are read and returns what fills one of them, but for its
  /// time.
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
      auto fill = prepare(first, count);
      for (std::size_t k = first; k < first + count; ++k) {
        T value{};
        value.acquired = static_cast<Time::rep>(k) * log_->period();
        fill(k, value);
        write_row(value, rows + (k - first) * numbers);
      }
    };
  }

  /// Throws SetupError unless each entry of the signal has a column.
  void need_all(const std::string& signal, int entries) const {
    const std::vector<MappedColumn>& columns = log_->mapping().columns;
    for (int entry = 0; entry < entries; ++entry) {
      const bool found = std::any_of(columns.begin(), columns.end(), [&](const MappedColumn& column) {
        return column.signal == signal && column.entry == entry;
      });
      if (!found)
        throw SetupError(log_->mapping().log.string() + ": no column is mapped to entry " +
                         std::to_string(entry) + " of " + signal);
    }
  }

  Cursor cursor(const char* signal, int entries) const { return {*log_, signal, entries}; }

  void add_joints(Recording& recording) {
    need_all("joints.active", robot_->drives());
    const bool has_passive = log_->has("joints.passive");
    if (has_passive) need_all("joints.passive", robot_->passive_joints());
    add<JointReading>("joints", recording, [this, has_passive](std::size_t, std::size_t) {
      return [active = cursor("joints.active", robot_->drives()),
              passive = cursor("joints.passive", robot_->passive_joints()),
              has_passive](std::size_t k, JointReading& reading) mutable {
        reading.active = active.at(k);
        reading.passive = passive.at(k);
        reading.valid = reading.active.allFinite();
        reading.passive_valid = reading.valid && has_passive && reading.passive.allFinite();
      };
    });
  }

  void add_drives(Recording& recording) {
    const bool has_current = log_->has("drives.current");
    if (!has_current && !log_->has(torque_signal)) return;
    const char* const signal = has_current ? "drives.current" : torque_signal;
    need_all(signal, robot_->drives());
    const JointVector constant = has_current ? JointVector(JointVector::Ones(robot_->drives()))
                                             : log_->mapping().scenario.control.drive_torque.torque_constant;
    add<DriveReading>("drives", recording, [this, signal, constant](std::size_t, std::size_t) {
      return [values = cursor(signal, robot_->drives()), constant](std::size_t k,
                                                                   DriveReading& reading) mutable {
        reading.current = values.at(k).cwiseQuotient(constant);
        reading.valid = reading.current.allFinite();
      };
    });
  }

  void add_imu(Recording& recording) {
    if (!log_->has("imu.angular_velocity") && !log_->has("imu.specific_force")) return;
    need_all("imu.angular_velocity", 3);
    need_all("imu.specific_force", 3);
    add<ImuReading>("imu", recording, [this](std::size_t, std::size_t) {
      return [velocity = cursor("imu.angular_velocity", 3), force = cursor("imu.specific_force", 3),
              axes = log_->mapping().imu_axes](std::size_t k, ImuReading& reading) mutable {
        reading.angular_velocity = axes * Eigen::Vector3d(velocity.at(k));
        reading.specific_force = axes * Eigen::Vector3d(force.at(k));
        reading.valid = reading.angular_velocity.allFinite() && reading.specific_force.allFinite();
      };
    });
  }

  void add_force_torque(Recording& recording) {
    if (!log_->has("force_torque.force")) return;
    if (log_->is_in_body("force_torque.force")) axes_.emplace(*log_);
    add<ForceTorqueReading>("force_torque", recording, [this](std::size_t first, std::size_t count) {
      std::vector<Eigen::Matrix3d> axes;
      if (axes_) axes = axes_->read(*log_, first, count);
      return [force = cursor("force_torque.force", 3), moment = cursor("force_torque.moment", 3), axes,
              first](std::size_t k, ForceTorqueReading& reading) mutable {
        const Eigen::Matrix3d turn =
            axes.empty() ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : axes[k - first];
        reading.force_in_base = turn * Eigen::Vector3d(force.at(k));
        reading.moment_in_base = turn * Eigen::Vector3d(moment.at(k));
        reading.valid = reading.force_in_base.allFinite() && reading.moment_in_base.allFinite();
      };
    });
  }

  std::shared_ptr<const MappedLog> log_;
  std::shared_ptr<const ParallelRobot> robot_;
  std::optional<InstrumentAxes> axes_;
  std::map<std::string, Writer> writers_;
};

}  // namespace

Recording imported_recording(const std::shared_ptr<const MappedLog>& log,
                             const std::map<std::string, std::string>& provenance) {
  Recording recording;
  recording.period = log->period();
  recording.source = std::make_shared<const ImportedRows>(log, recording);
  recording.time_ns.resize(log->samples());
  for (std::size_t k = 0; k < log->samples(); ++k)
    recording.time_ns[k] = (static_cast<Time::rep>(k) * recording.period).count();
  recording.attributes = recorded_attributes(log->mapping().scenario, provenance);
  recording.attributes["imported.from"] = log->mapping().log.filename().string();
  return recording;
}

Recording import_log(const std::filesystem::path& mapping,
                     const std::map<std::string, std::string>& provenance) {
  return imported_recording(std::make_shared<const MappedLog>(read_log_mapping(mapping)), provenance);
}

std::vector<std::filesystem::path> files_of(const LogMapping& mapping) {
  std::vector<std::filesystem::path> files = {mapping.log, mapping.scenario.robot_file};
  if (!mapping.file.empty()) files.push_back(mapping.file);
  if (!mapping.scenario_file.empty()) files.push_back(mapping.scenario_file);
  return files;
}

}  // namespace flinch
