#include "import/log_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <utility>

#include "import/hdf5_log.h"
#include "import/matlab_log.h"
#include "import/mcap_log.h"
#include "import/mcap_records.h"
#include "import/numpy_log.h"
#include "import/text_log.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/readable_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t most_suggested = 1000;

/// The column of a number counted from 1; none: the name is no such number.
std::optional<std::size_t> numbered(const std::string& name, std::size_t columns) {
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data(), end, number);
  if (error != std::errc{} || rest != end || number < 1 || number > columns) return std::nullopt;
  return number - 1;
}

}  // namespace

LogFile::~LogFile() = default;

std::size_t LogFile::find(const std::string& name) const {
  const auto at = [&](const std::string& wanted) {
    return static_cast<std::size_t>(std::find_if(columns_.begin(), columns_.end(),
                                                 [&](const LogColumn& each) { return each.name == wanted; }) -
                                    columns_.begin());
  };
  const std::size_t found = at(name);
  if (found < columns_.size()) return found;
  if (at(name + "#2") < columns_.size())
    throw SetupError(file_.string() + ": several columns are called '" + name + "'; name '" + name +
                     "#1', '" + name + "#2', ...");
  if (const auto column = numbered(name, columns_.size())) return *column;
  std::vector<std::string> known;
  for (const LogColumn& each : columns_) {
    if (known.size() < most_suggested) known.push_back(each.name);
  }
  throw SetupError(file_.string() + ": there is no column '" + name + "'" + did_you_mean(name, known));
}

void LogFile::throw_if_empty(const std::string& what) const {
  if (!columns_.empty()) return;
  std::vector<std::string> problems = {file_.string() + ": holds no " + what};
  for (const std::string& remark : remarks_) problems.push_back(file_.string() + ": " + remark);
  throw SetupError(problems);
}

std::vector<std::int64_t> LogFile::instants_of_numbers(std::size_t column, ClockUnit unit,
                                                       std::size_t most_rows) {
  const std::vector<double> values = std::move(read(std::array{column}, most_rows).front());
  std::vector<std::int64_t> instants;
  for (const double value : values) instants.push_back(instant_of(value, unit));
  return instants;
}

std::unique_ptr<LogFile> open_log(const std::filesystem::path& file) {
  const std::string problem = problem_with_reading(file);
  if (!problem.empty()) throw SetupError(file.string() + ": " + problem);
  std::string head(8, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (!stream && stream.gcount() == 0) throw SetupError(file.string() + ": the file cannot be read");
  if (is_hdf5(file)) return std::make_unique<Hdf5Log>(file);
  if (is_mcap(file)) return std::make_unique<McapLog>(file);
  if (is_matlab(file)) return std::make_unique<MatlabLog>(file);
  if (is_numpy(file) || is_zip(file)) return std::make_unique<NumpyLog>(file);
  return std::make_unique<TextLog>(file);
}

std::int64_t instant_of(double value, ClockUnit unit) {
  const double nanoseconds = value * static_cast<double>(unit);
  if (!(std::abs(nanoseconds) < 9e18)) return no_instant;
  return std::llround(nanoseconds);
}

void number_equal_names(std::vector<LogColumn>& columns) {
  std::map<std::string, std::size_t> count, next;
  for (const LogColumn& column : columns) ++count[column.name];
  for (LogColumn& column : columns) {
    const std::string name = column.name;
    if (count[name] > 1) column.name += "#" + std::to_string(++next[name]);
  }
}

}  // namespace flinch
