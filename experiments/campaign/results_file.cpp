#include "experiments/campaign/results_file.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string>

#include "experiments/campaign/run_result.h"
#include "systems/foundation/result_file.h"
#include "systems/framework/table_file.h"

namespace flinch {
namespace {

std::optional<double> number(const std::string& cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (cell.empty()) return value;
  const char* const end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, value);
  return error == std::errc{} && rest == end ? std::optional(value) : std::nullopt;
}

/// Numbers where every cell is one or empty; texts otherwise, and for seeds, which have more digits.
TableColumn column_of(const std::string& name, const std::vector<std::string>& cells) {
  std::vector<double> numbers;
  for (const std::string& cell : cells) {
    const auto value = number(cell);
    if (!value || name == "seed" || name == "fault") return {name, cells};
    numbers.push_back(*value);
  }
  return {name, numbers};
}

/// The columns of all results, each once, with a cell for each result: "" where it has no such column.
struct Cells {
  explicit Cells(const std::vector<RunResult>& results) {
    std::string last_header;
    std::vector<std::size_t> places;
    for (std::size_t row = 0; row < results.size(); ++row) {
      if (std::string header = csv_header(results[row]); header != last_header) {
        last_header = std::move(header);
        places.clear();
        for (const std::string& name : csv_cells(last_header))
          places.push_back(place_of(name, results.size()));
      }
      std::vector<std::string> cells = csv_cells(csv_row(results[row]));
      for (std::size_t i = 0; i < cells.size(); ++i) columns[places[i]][row] = std::move(cells[i]);
    }
  }

  std::string line(std::size_t row) const {
    std::string text;
    for (const auto& column : columns)
      text += (&column == &columns.front() ? "" : ",") + csv_cell(column[row]);
    return text;
  }

  std::vector<std::string> names;
  std::vector<std::vector<std::string>> columns;

 private:
  std::size_t place_of(const std::string& name, std::size_t rows) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    names.push_back(name);
    columns.emplace_back(rows);
    return names.size() - 1;
  }
};

}  // namespace

void write_results(const std::vector<RunResult>& results, const std::filesystem::path& folder) {
  const Cells cells(results);
  std::string text;
  for (const std::string& name : cells.names) text += (text.empty() ? "" : ",") + csv_cell(name);
  text += "\n";
  for (std::size_t row = 0; row < results.size(); ++row) text += cells.line(row) + "\n";
  write_result(folder / "results.csv", text);
  std::vector<TableColumn> columns;
  for (std::size_t i = 0; i < cells.names.size(); ++i)
    columns.push_back(column_of(cells.names[i], cells.columns[i]));
  write_table(columns, {{"format", "flinch campaign"}}, folder / "results.h5");
}

}  // namespace flinch
