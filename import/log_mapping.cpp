#include "import/log_mapping.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using Quantity = UnitWord::Quantity;

bool is_drive_signal(const std::string& signal) {
  return signal == "drives.current" || signal == torque_signal;
}

/// SI of one of the unit that is written there; a problem is noted. Some units need another number.
double factor_of(ConfigReader& reader, const std::string& written, Quantity quantity) {
  if (written == "counts") {
    double counts = 0.0;
    reader.required().number("counts_per_turn", unit::none, counts, positive);
    if (quantity != Quantity::angle) reader.problem("unit", "is 'counts', which are of an angle");
    return counts > 0.0 ? 2.0 * std::numbers::pi / counts : 1.0;
  }
  if (written == "permille" || written == "percent") {
    double rated = 0.0;
    if (quantity == Quantity::current) {
      reader.required().number("rated", unit::A, rated, positive);
    } else if (quantity == Quantity::moment) {
      reader.required().number("rated", unit::Nm, rated, positive);
    } else {
      reader.problem("unit", "is '" + written + "', which is of a rated current or torque");
    }
    return rated * (written == "permille" ? 1e-3 : 1e-2);
  }
  const std::optional<UnitWord> word = unit_word(written);
  if (word && word->quantity == quantity) return word->to_si;
  std::string others = quantity == Quantity::angle ? ", counts" : "";
  if (quantity == Quantity::current || quantity == Quantity::moment) others = ", permille, percent";
  reader.problem("unit", "is '" + written + "', which is no unit of this quantity; known are: " +
                             unit_words(quantity) + others);
  return 1.0;
}

ClockUnit clock_unit(ConfigReader& reader, std::string_view key, const std::string& written) {
  const std::optional<UnitWord> word = unit_word(written);
  if (!word || word->quantity != Quantity::time) {
    reader.problem(
        key, "is '" + written + "', which is no unit of time; known are: " + unit_words(Quantity::time));
    return ClockUnit::s;
  }
  return static_cast<ClockUnit>(std::llround(word->to_si * 1e9));
}

LogClock read_clock(ConfigReader time) {
  LogClock clock;
  std::string written = "s", second = "ns";
  time.required().text("column", clock.column);
  time.text("unit", written);
  time.text("second_column", clock.second_column);
  time.text("second_unit", second);
  clock.unit = clock_unit(time, "unit", written);
  clock.second_unit = clock_unit(time, "second_unit", second);
  return clock;
}

/// The size of a turn in the numbers of the column, where its joint turns.
double turn_of(const MappedColumn& column, Quantity quantity) {
  if (quantity != Quantity::angle) return 0.0;
  return std::abs(2.0 * std::numbers::pi / column.scale);
}

MappedColumn read_column(ConfigReader& reader, const ParallelRobot& robot) {
  MappedColumn column;
  std::string written, frame = "base";
  int sign = 1;
  double offset = 0.0, scale = 1.0, gear = 1.0;
  bool negate = false, wraps = true;
  reader.required().text("column", column.column);
  reader.required().text("signal", column.signal);
  reader.required().text("unit", written);
  reader.integer("entry", column.entry, 0, 5);
  reader.integer("sign", sign, -1, 1);
  reader.flag("negate", negate);
  reader.number("offset", unit::none, offset);
  reader.number("scale", unit::none, scale);
  reader.number("gear", unit::none, gear);
  reader.flag("unwrap", wraps);
  reader.text("frame", frame);
  if (reader.has("time")) column.clock = read_clock(reader.section("time"));
  std::vector<std::string> known;
  double factor = 1.0;
  for (const LogSignal& signal : log_signals(robot)) {
    known.emplace_back(signal.name);
    if (signal.name != column.signal) continue;
    factor = factor_of(reader, written, signal.quantity);
    // A motor turns so many times as fast as its drive, with so much less torque.
    const bool is_torque = signal.quantity == Quantity::moment || signal.quantity == Quantity::force;
    column.scale = scale * factor * (is_torque ? gear : 1.0 / gear);
    if (column.entry >= signal.entries)
      reader.problem("entry", "is " + std::to_string(column.entry) + "; the signal has " +
                                  std::to_string(signal.entries) + " entries, counted from 0");
    if (wraps) column.turn = turn_of(column, signal.quantity);
  }
  if (std::find(known.begin(), known.end(), column.signal) == known.end())
    reader.problem("signal",
                   "is '" + column.signal + "', which is none" + did_you_mean(column.signal, known));
  if (sign == 0) reader.problem("sign", "is 0; it must be 1 or -1");
  if (scale == 0.0) reader.problem("scale", "is 0");
  if (gear == 0.0) reader.problem("gear", "is 0");
  if (frame != "base" && frame != "body")
    reader.problem("frame", "is '" + frame + "'; it must be base or body");
  column.in_body = frame == "body";
  column.offset = factor * offset;
  if ((sign < 0) != negate) column.scale = -column.scale;
  return column;
}

/// Two columns that are one entry, and torques beside currents.
void require_one_each(ConfigReader& reader, const std::vector<MappedColumn>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const bool same = columns[i].signal == columns[k].signal && columns[i].entry == columns[k].entry;
      const bool both = is_drive_signal(columns[i].signal) && is_drive_signal(columns[k].signal) &&
                        columns[i].entry == columns[k].entry;
      if (!same && !both) continue;
      reader.problem("", "entry " + std::to_string(columns[i].entry) + " of " + columns[i].signal +
                             " is mapped twice, to the columns '" + columns[k].column + "' and '" +
                             columns[i].column + "'" +
                             (same ? "" : "; a drive has a current or a torque, not both"));
    }
  }
}

Eigen::Matrix3d read_imu_turn(ConfigReader turn) {
  double x = 0.0, y = 0.0, z = 0.0;
  turn.number("about_x", unit::rad, x);
  turn.number("about_y", unit::rad, y);
  turn.number("about_z", unit::rad, z);
  using Turn = Eigen::AngleAxisd;
  return (Turn(z, Eigen::Vector3d::UnitZ()) * Turn(y, Eigen::Vector3d::UnitY()) *
          Turn(x, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// The robot by itself or in a scenario, whichever stands there; none: it cannot be read.
bool read_robot(ConfigReader& reader, LogMapping& mapping) {
  std::filesystem::path robot;
  const bool alone = reader.one_of({"scenario", "robot"}) == "robot";
  if (alone) {
    reader.required().file("robot", robot);
  } else {
    reader.required().file("scenario", mapping.scenario_file);
  }
  const std::filesystem::path& named = alone ? robot : mapping.scenario_file;
  if (named.empty()) return false;
  try {
    mapping.scenario = alone ? scenario_of_robot(robot) : read_scenario(mapping.scenario_file);
    return true;
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
    return false;
  }
}

}  // namespace

std::vector<LogSignal> log_signals(const ParallelRobot& robot) {
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  return {{"joints.active", turns ? Quantity::angle : Quantity::length, robot.drives()},
          {"joints.passive", Quantity::angle, robot.passive_joints()},
          {"drives.current", Quantity::current, robot.drives()},
          {torque_signal, turns ? Quantity::moment : Quantity::force, robot.drives()},
          {"imu.angular_velocity", Quantity::angular_velocity, 3},
          {"imu.specific_force", Quantity::acceleration, 3},
          {"force_torque.force", Quantity::force, 3},
          {"force_torque.moment", Quantity::moment, 3}};
}

LogMapping read_log_mapping(const std::filesystem::path& file) {
  LogMapping mapping;
  mapping.file = file;
  ConfigReader reader = ConfigReader::open(file);
  require_kind(reader, FileKind::mapping);
  const std::string_view log = reader.one_of({"log", "csv", "hdf5"});
  if (!log.empty()) reader.required().file(log, mapping.log);
  std::string separator;
  reader.text("separator", separator);  // of older files: it is found
  Time written{};
  reader.duration("period", written, between(1e-5, 1.0));
  if (written != Time::zero()) mapping.period = written;
  mapping.clock = read_clock(reader.required().section("time"));
  int phase = 0;
  reader.integer("phase", phase, 1);
  if (phase > 0) mapping.phase = phase;
  double to = 0.0;
  reader.number("from", unit::s, mapping.from, between(0.0, 1e6));
  reader.number("to", unit::s, to, between(0.0, 1e6));
  if (to > 0.0) mapping.to = to;
  if (mapping.to && *mapping.to <= mapping.from) reader.problem("to", "is not after 'from'");
  if (reader.has("imu_axes")) mapping.imu_axes = read_imu_turn(reader.section("imu_axes"));
  const bool has_robot = read_robot(reader, mapping);
  for (ConfigReader& column : reader.sections("columns")) {
    if (has_robot) {
      mapping.columns.push_back(read_column(column, *mapping.scenario.robot.robot));
    } else {
      column.leave_rest_unread();
    }
  }
  require_one_each(reader, mapping.columns);
  reader.finish();
  return mapping;
}

Scenario scenario_of_robot(const std::filesystem::path& robot) {
  const std::filesystem::path place = std::filesystem::absolute(robot).parent_path() / "readings.yaml";
  return parse_scenario(
      "robot: \"" + robot.filename().string() +
          "\"\ntitle: Readings of another program\nduration_s: 1\nexpect: {contact: none}\n",
      place);
}

}  // namespace flinch
