#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "import/log_file.h"
#include "import/unit_words.h"

namespace flinch {

/// What columns of a log can be of a robot.
struct LogSignal {
  const char* name;  ///< "joints.active"
  UnitWord::Quantity quantity;
  int entries;
};
std::vector<LogSignal> log_signals(const ParallelRobot& robot);

/// A clock of a log: a column, or the sum of two, such as a date and a time, or seconds and nanoseconds.
struct LogClock {
  std::string column;
  ClockUnit unit = ClockUnit::s;
  std::string second_column{};
  ClockUnit second_unit = ClockUnit::ns;

  friend bool operator==(const LogClock&, const LogClock&) = default;
};

/// A column of a log, and what it is: SI value = scale x number + offset.
struct MappedColumn {
  std::string column;
  std::string signal;
  int entry = 0;
  double scale = 1.0;    ///< to SI, with the sign
  double offset = 0.0;   ///< SI
  double turn = 0.0;     ///< in the numbers of the column, where it is an angle that may wrap; 0: it does not
  bool in_body = false;  ///< a force in the axes of the body on which the instrument sits
  std::optional<LogClock> clock{};  ///< none: that of the log
};

/// What a log is: which columns are what, when, of which robot.
struct LogMapping {
  std::filesystem::path file{};  ///< that says it; "": it was guessed
  std::filesystem::path log;
  std::filesystem::path scenario_file{};  ///< "": the mapping names a robot alone
  Scenario scenario;
  std::optional<Time> period{};  ///< of the recording; none: that of the log
  LogClock clock;
  std::optional<int> phase{};  ///< from 1, where the time restarts; none: the longest
  double from = 0.0;           ///< since the first instant [s]
  std::optional<double> to{};  ///< none: its end
  std::vector<MappedColumn> columns;
  Eigen::Matrix3d imu_axes = Eigen::Matrix3d::Identity();  ///< of the IMU in the axes that the log has
};

/// Reads the mapping of a log (YAML); docs/files.md has the keys. Throws SetupError with all that is wrong.
LogMapping read_log_mapping(const std::filesystem::path& file);

/// A scenario that has a robot and nothing else.
Scenario scenario_of_robot(const std::filesystem::path& robot);

/// A torque that is logged instead of a current is told by the current that makes it.
inline constexpr const char* torque_signal = "drives.torque";

}  // namespace flinch
