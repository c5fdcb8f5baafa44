#include "calibration/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t most_problems = 10;

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  std::size_t begin = 0;
  while (begin < text.size() && blank(text[begin])) ++begin;
  return text.substr(begin);
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t end; (end = line.find(separator, begin)) != std::string::npos; begin = end + 1)
    cells.push_back(trimmed(line.substr(begin, end - begin)));
  cells.push_back(trimmed(line.substr(begin)));
  return cells;
}

/// Whether `text` is a finite number, which is then in `value`.
bool is_number(const std::string& text, double& value) {
  const char* const begin = text.starts_with('+') ? text.data() + 1 : text.data();
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  return error == std::errc{} && rest == end && std::isfinite(value);
}

}  // namespace

int CsvTable::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

CsvTable read_csv(const std::filesystem::path& file, char separator, const std::vector<std::string>& wanted) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  if (!stream || !std::getline(stream, line))
    throw SetupError(file.string() + ": the file cannot be read or is empty");
  const std::vector<std::string> names = split(line, separator);
  std::vector<std::string> problems;
  std::vector<std::size_t> columns;
  for (const std::string& name : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    columns.push_back(static_cast<std::size_t>(found - names.begin()));
    if (found == names.end())
      problems.push_back(file.string() + ":1: there is no column '" + name + "'" + did_you_mean(name, names));
  }
  throw_if_any(problems);

  std::vector<double> values;  // row by row, only what is wanted
  std::size_t row = 1;
  while (std::getline(stream, line)) {
    ++row;
    if (trimmed(line).empty()) continue;
    const std::vector<std::string> cells = split(line, separator);
    for (std::size_t i = 0; i < columns.size() && problems.size() < most_problems; ++i) {
      const std::size_t column = columns[i];
      double value = 0.0;
      const std::string place = file.string() + ":" + std::to_string(row) + ": column '" + wanted[i] + "'";
      if (column >= cells.size()) {
        problems.push_back(place + " is missing; the row has " + std::to_string(cells.size()) + " cells");
      } else if (!is_number(cells[column], value)) {
        problems.push_back(place + " is '" + cells[column] + "'; it must be a number");
      }
      values.push_back(value);
    }
    if (problems.size() >= most_problems) break;
  }
  throw_if_any(problems);
  const auto width = static_cast<Eigen::Index>(wanted.size());
  const auto rows = width == 0 ? 0 : static_cast<Eigen::Index>(values.size()) / width;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return {wanted, Eigen::Map<const Rows>(values.data(), rows, width)};
}

}  // namespace flinch
