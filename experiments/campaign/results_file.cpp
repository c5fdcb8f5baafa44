#include "experiments/campaign/results_file.h"

#include <charconv>
#include <limits>
#include <optional>
#include <string>

#include "experiments/campaign/campaign_journal.h"
#include "experiments/campaign/run_result.h"
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

}  // namespace

void write_results(const std::vector<RunResult>& results, const std::filesystem::path& folder) {
  if (results.empty()) return;
  const std::string header = csv_header(results.front());
  const std::vector<std::string> names = csv_cells(header);
  std::vector<std::vector<std::string>> cells(names.size());
  std::string text = header + "\n";
  for (const RunResult& result : results) {
    const std::string row = csv_row(result);
    text += row + "\n";
    const std::vector<std::string> in_row = csv_cells(row);
    for (std::size_t i = 0; i < names.size(); ++i) cells[i].push_back(in_row[i]);
  }
  replace_file(folder / "results.csv", text);
  std::vector<TableColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) columns.push_back(column_of(names[i], cells[i]));
  write_table(columns, {{"format", "flinch campaign"}}, folder / "results.h5");
}

}  // namespace flinch
