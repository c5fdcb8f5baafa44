#include "learning/data_set.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "systems/config/robot_file.h"
#include "systems/foundation/fnv1a.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/hdf5_table.h"

namespace flinch {
namespace {

constexpr const char* format = "flinch contacts 2";
constexpr std::size_t first_columns = 7;

std::size_t columns_of(const ParallelRobot& robot) {
  return first_columns + static_cast<std::size_t>(robot.home_pose().size()) +
         2 * window_ages.size() * static_cast<std::size_t>(robot.dof());
}

std::string column_names(const ParallelRobot& robot) {
  std::string names = "run configuration moment touched since_onset_s since_early_s force_N";
  const auto add = [&names](const std::string& name, Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i) names += fmt::format(" {}_{}", name, i + 1);
  };
  add("pose", robot.home_pose().size());
  for (const Time age : window_ages) {
    add(fmt::format("wrench_{}ms", age / 1ms), robot.dof());
    add(fmt::format("velocity_{}ms", age / 1ms), robot.dof());
  }
  return names;
}

template <class Vector>
void append(const Vector& vector, std::vector<internal::Number>& row) {
  for (const double value : vector) row.push_back({.real = value});
}

void append(const DataSample& sample, std::vector<internal::Number>& row) {
  for (const int value : {sample.run, sample.configuration, sample.moment, sample.touched})
    row.push_back({.real = static_cast<double>(value)});
  for (const double value : {sample.since_onset, sample.since_early, sample.force})
    row.push_back({.real = value});
  append(sample.pose, row);
  for (const ContactMoment& moment : sample.course) {
    append(moment.wrench_in_base, row);
    append(moment.velocity, row);
  }
}

/// Takes the numbers of a row one after the other.
class RowReader {
 public:
  RowReader(const internal::Number* row, std::size_t number) : next_(row), number_(number) {}

  double real() {
    const double value = (next_++)->real;
    if (!std::isfinite(value)) fail("has a number that is not finite");
    return value;
  }
  int whole(int least, int end) {
    const double value = real();
    if (value < least || value >= end || value != std::floor(value)) {
      fail(fmt::format("has {} where a whole number from {} to {} belongs", value, least, end - 1));
    }
    return static_cast<int>(value);
  }
  template <class Vector>
  void vector(Eigen::Index size, Vector& into) {
    into.resize(size);
    for (double& value : into) value = real();
  }

 private:
  [[noreturn]] void fail(const std::string& complaint) const {
    throw SetupError(fmt::format("sample {} {}", number_, complaint));
  }
  const internal::Number* next_;
  std::size_t number_;
};

DataSample sample_of(const internal::Number* row, std::size_t number, const ParallelRobot& robot) {
  RowReader reader(row, number);
  DataSample sample;
  sample.run = reader.whole(0, 1'000'000'000);
  sample.configuration = reader.whole(0, 1'000'000'000);
  sample.moment = reader.whole(0, 8);
  sample.touched = reader.whole(0, classes_of(robot).count());
  sample.since_onset = reader.real();
  sample.since_early = reader.real();
  sample.force = reader.real();
  reader.vector(robot.home_pose().size(), sample.pose);
  for (ContactMoment& moment : sample.course) {
    reader.vector(robot.dof(), moment.wrench_in_base);
    reader.vector(robot.dof(), moment.velocity);
  }
  return sample;
}

void write_samples(const DataSet& data, internal::Hdf5Object::Id file) {
  constexpr std::size_t chunk = 4096;
  const std::size_t columns = columns_of(*data.robot);
  const internal::Hdf5Object table = internal::make_table(file, "samples", Field::Kind::real, columns, chunk);
  std::vector<internal::Number> rows;
  for (std::size_t first = 0; first < data.samples.size(); first += chunk) {
    const std::size_t end = std::min(first + chunk, data.samples.size());
    rows.clear();
    for (std::size_t i = first; i < end; ++i) append(data.samples[i], rows);
    internal::append_rows(table, Field::Kind::real, first, end - first, columns, rows.data());
  }
}

void read_samples(internal::Hdf5Object::Id file, DataSet& data) {
  constexpr std::size_t block = 4096;
  const std::size_t columns = columns_of(*data.robot);
  internal::Table table = internal::open_table(file, "samples", Field::Kind::real, columns);
  const std::size_t count = table.rows;
  std::vector<internal::Number> rows(block * columns);
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t read = std::min(block, count - first);
    internal::read_rows(table, Field::Kind::real, first, read, columns, rows.data());
    for (std::size_t i = 0; i < read; ++i)
      data.samples.push_back(sample_of(rows.data() + i * columns, first + i, *data.robot));
  }
}

DataSet read(const std::filesystem::path& file) {
  const std::lock_guard lock(internal::hdf5_mutex());
  const internal::Hdf5Object hdf5 = internal::open_hdf5_file(file);
  DataSet data;
  const std::vector<std::string> names = internal::attribute_names(hdf5);
  const bool says_what_it_is = std::find(names.begin(), names.end(), "format") != names.end();
  const std::string says = says_what_it_is ? internal::read_text(hdf5, "format") : "";
  if (says != format) {
    throw SetupError(says.starts_with("flinch contacts ")
                         ? "is a data set of another version ('" + says +
                               "'); make it anew with 'flinch dataset'"
                         : "this is no data set of contacts; 'flinch dataset' makes one");
  }
  for (const std::string& name : names) data.card[name] = internal::read_text(hdf5, name);
  data.robot_file = data.card["robot.file"];
  data.robot_text = data.card["robot.text"];
  data.robot = parse_robot_file(data.robot_text, data.robot_file).robot;
  if (data.card["columns"] != column_names(*data.robot)) {
    throw SetupError("its columns are '" + data.card["columns"] + "'; they must be '" +
                     column_names(*data.robot) + "'");
  }
  read_samples(hdf5, data);
  for (const char* own : {"format", "robot.file", "robot.text", "columns"}) data.card.erase(own);
  return data;
}

/// Whether it says when the robot is stopped or how often it is controlled, on which no feature of a contact
/// depends.
bool is_of_control(const std::string& key) {
  return key.starts_with("workspace_limits.") || key.starts_with("drives.max_") || key == "control_period";
}

}  // namespace

ContactClasses classes_of(const ParallelRobot& robot) { return {robot.body_count(), robot.legs()}; }

std::string fingerprint(const std::string& robot_text, const std::string& robot_file) {
  std::uint64_t hash = fnv1a("");
  for (const ReadValue& value : parse_robot_file(robot_text, robot_file).values) {
    if (is_of_control(value.key)) continue;
    hash = fnv1a(value.key + "=" + value.value + "\n", hash);
  }
  return fmt::format("{:016x}", hash);
}

std::string counts_table(const DataSet& data) {
  const ContactClasses classes = classes_of(*data.robot);
  std::map<std::pair<int, int>, std::pair<std::size_t, std::set<int>>> counts;
  std::set<int> configurations;
  for (const DataSample& sample : data.samples) configurations.insert(sample.configuration);
  const bool is_each = configurations.size() <= 10;
  for (const DataSample& sample : data.samples) {
    auto& [samples, runs] = counts[{is_each ? sample.configuration : -1, sample.touched}];
    ++samples;
    runs.insert(sample.run);
  }
  std::string text =
      fmt::format("{:<20} {:<16} {:>8} {:>10}\n", "configuration", "touched", "runs", "samples");
  for (const auto& [place, count] : counts) {
    const std::string where =
        is_each ? std::to_string(place.first) : fmt::format("all {} together", configurations.size());
    text += fmt::format("{:<20} {:<16} {:>8} {:>10}\n", where, classes.name(place.second),
                        count.second.size(), count.first);
  }
  return text;
}

void write_data_set(const DataSet& data, const std::filesystem::path& file) {
  const std::size_t numbers = data.samples.size() * columns_of(*data.robot);
  internal::write_hdf5_result(file, numbers * sizeof(internal::Number), [&](internal::Hdf5Object::Id hdf5) {
    internal::write_text(hdf5, "format", format);
    internal::write_text(hdf5, "columns", column_names(*data.robot));
    internal::write_text(hdf5, "robot.file", data.robot_file);
    internal::write_text(hdf5, "robot.text", data.robot_text);
    for (const auto& [name, text] : data.card) internal::write_text(hdf5, name, text);
    write_samples(data, hdf5);
  });
}

DataSet read_data_set(const std::filesystem::path& file) {
  DataSet data = out_of(file.string(), [&file] { return read(file); });
  data.sha256 = sha256_of(file);
  return data;
}

}  // namespace flinch
