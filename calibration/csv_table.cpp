#include "calibration/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/readable_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t most_problems = 10;
constexpr std::size_t most_shown = 100;  // letters of a cell

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\"";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) + 1 - begin);
}

/// The cells of a line, one after the other: a row may have millions that nobody wants.
class Cells {
 public:
  Cells(std::string_view line, char separator) : rest_(line), separator_(separator) {}

  /// The next cell; none after the last.
  std::optional<std::string_view> next() {
    if (ended_) return std::nullopt;
    const std::size_t end = rest_.find(separator_);
    ended_ = end == std::string_view::npos;
    const std::string_view cell = trimmed(rest_.substr(0, end));
    if (!ended_) rest_.remove_prefix(end + 1);
    return cell;
  }

 private:
  std::string_view rest_;
  char separator_;
  bool ended_ = false;
};

/// Whether `text` is a finite number, which is then in `value`.
bool is_number(std::string_view text, double& value) {
  const char* const begin = text.starts_with('+') ? text.data() + 1 : text.data();
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  return error == std::errc{} && rest == end && std::isfinite(value);
}

/// Where a wanted column stands in the file, and in the table.
struct FoundColumn {
  std::size_t in_file;
  Eigen::Index in_table;
};

/// The wanted columns in the order of the file, by its first line. Throws SetupError naming those that are
/// not there.
std::vector<FoundColumn> places_of(const std::vector<std::string>& wanted, std::string_view line,
                                   char separator, const std::string& file) {
  constexpr std::size_t most_suggested = 1000;
  std::vector<std::string> suggested;
  std::map<std::string_view, std::size_t> first;  // of the names that are wanted
  for (const std::string& name : wanted) first.emplace(name, std::string::npos);
  Cells cells(line, separator);
  std::size_t column = 0;
  for (auto cell = cells.next(); cell; cell = cells.next(), ++column) {
    if (suggested.size() < most_suggested) suggested.emplace_back(*cell);
    const auto found = first.find(*cell);
    if (found != first.end() && found->second == std::string::npos) found->second = column;
  }
  std::vector<std::string> problems;
  std::vector<FoundColumn> places;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    places.push_back({first[wanted[i]], static_cast<Eigen::Index>(i)});
    if (places.back().in_file != std::string::npos) continue;
    problems.push_back(file + ":1: there is no column '" + wanted[i] + "'" +
                       did_you_mean(wanted[i], suggested));
  }
  throw_if_any(std::move(problems));
  std::sort(places.begin(), places.end(),
            [](const FoundColumn& a, const FoundColumn& b) { return a.in_file < b.in_file; });
  return places;
}

bool is_blank(std::string_view line) { return trimmed(line).empty(); }

/// Rows below the header that are not blank. No more than can have a number and a separator in each of the
/// wanted columns, and one: where there are more, one of these is too short.
Eigen::Index rows_of(const std::filesystem::path& file, std::size_t columns) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  std::getline(stream, line);
  std::size_t rows = 0, bytes = 0;
  while (std::getline(stream, line)) {
    rows += is_blank(line) ? 0 : 1;
    bytes += line.size() + 1;
  }
  return static_cast<Eigen::Index>(std::min(rows, 1 + bytes / (2 * std::max<std::size_t>(columns, 1))));
}

/// Reads a row of the file into a row of the table; `place` names it where there are problems.
void read_row(std::string_view line, char separator, const std::vector<FoundColumn>& places, CsvTable& table,
              Eigen::Index row, const std::string& place, std::vector<std::string>& problems) {
  Cells cells(line, separator);
  std::size_t column = 0;
  std::optional<std::string_view> cell = cells.next();
  for (const FoundColumn& wanted : places) {
    if (problems.size() >= most_problems) return;
    for (; cell && column < wanted.in_file; ++column) cell = cells.next();
    double value = 0.0;
    const auto told = [&] {
      return place + ": column '" + table.names[static_cast<std::size_t>(wanted.in_table)] + "'";
    };
    if (!cell) {
      problems.push_back(told() + " is missing; the row has " + std::to_string(column) + " cells");
    } else if (!is_number(*cell, value)) {
      problems.push_back(told() + " is '" + std::string(cell->substr(0, most_shown)) +
                         "'; it must be a number");
    }
    table.values(row, wanted.in_table) = value;
  }
}

}  // namespace

int CsvTable::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::vector<std::string> each_once(const std::vector<std::string>& names) {
  std::vector<std::string> once;
  std::set<std::string_view> known;
  for (const std::string& name : names) {
    if (known.insert(name).second) once.push_back(name);
  }
  return once;
}

CsvTable read_csv(const std::filesystem::path& file, char separator, const std::vector<std::string>& wanted) {
  const std::string problem = problem_with_reading(file);
  if (!problem.empty()) throw SetupError(file.string() + ": " + problem);
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  if (!stream || !std::getline(stream, line)) throw SetupError(file.string() + ": the file cannot be read");
  if (line.starts_with("\x89HDF")) throw SetupError(file.string() + ": is an HDF5 file; name it as 'hdf5'");
  if (line.find('\0') != std::string::npos)
    throw SetupError(file.string() + ": is no text; it must be CSV, with names of columns in its first row");
  CsvTable table{.names = each_once(wanted), .values = {}};
  const std::vector<FoundColumn> places = places_of(table.names, line, separator, file.string());
  line = {};  // it may be longer than all that follows
  table.values.resize(rows_of(file, places.size()), static_cast<Eigen::Index>(places.size()));
  std::vector<std::string> problems;
  std::size_t number = 1;
  for (Eigen::Index row = 0; row < table.values.rows() && std::getline(stream, line);) {
    ++number;
    if (is_blank(line)) continue;
    read_row(line, separator, places, table, row, file.string() + ":" + std::to_string(number), problems);
    if (problems.size() >= most_problems) break;
    ++row;
  }
  throw_if_any(std::move(problems));
  return table;
}

}  // namespace flinch
