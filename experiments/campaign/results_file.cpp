#include "experiments/campaign/results_file.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/campaign/campaign_results.h"
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

/// The columns of all results, each once.
class Columns {
 public:
  explicit Columns(const CampaignResults& results) {
    for (const RunResult& result : results) {
      const std::vector<std::string> cells = cells_of(result);
      for (std::size_t i = 0; i < cells.size(); ++i) columns_[i].hold(cells[i]);
    }
  }

  /// A cell for each column known so far: "" where the result has no such column.
  std::vector<std::string> cells_of(const RunResult& result) {
    if (std::string header = csv_header(result); header != last_header_) {
      last_header_ = std::move(header);
      places_.clear();
      for (const std::string& name : csv_cells(last_header_)) places_.push_back(place_of(name));
    }
    std::vector<std::string> own = csv_cells(csv_row(result));
    std::vector<std::string> cells(columns_.size());
    for (std::size_t i = 0; i < own.size(); ++i) cells[places_[i]] = std::move(own[i]);
    return cells;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Column& column : columns_) names.push_back(column.name);
    return names;
  }

  std::vector<TableColumn> of_table() const {
    std::vector<TableColumn> columns;
    for (const Column& column : columns_)
      columns.push_back({column.name, column.has_numbers ? std::nullopt : std::optional(column.width)});
    return columns;
  }

 private:
  /// Of numbers where every cell is one or empty; of texts otherwise, and of seeds, which have more digits.
  struct Column {
    std::string name;
    bool has_numbers = true;
    std::size_t width = 0;

    void hold(const std::string& cell) {
      has_numbers = has_numbers && name != "seed" && name != "fault" && number(cell).has_value();
      width = std::max(width, cell.size());
    }
  };

  std::size_t place_of(const std::string& name) {
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const Column& column) { return column.name == name; });
    const auto place = static_cast<std::size_t>(found - columns_.begin());
    if (found == columns_.end()) columns_.push_back({.name = name});
    return place;
  }

  std::vector<Column> columns_;
  std::string last_header_;
  std::vector<std::size_t> places_;  ///< of its names
};

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (&cell == &cells.front() ? "" : ",") + csv_cell(cell);
  return line + "\n";
}

}  // namespace

void write_results(const CampaignResults& results, const std::filesystem::path& folder) {
  Columns columns(results);
  ResultFile csv(folder / "results.csv");
  csv.write(csv_line(columns.names()));
  for (const RunResult& result : results) csv.write(csv_line(columns.cells_of(result)));
  csv.finish();

  const std::vector<TableColumn> of_table = columns.of_table();
  const auto row = [&](std::size_t place) {
    std::vector<TableCell> cells;
    for (std::string& cell : columns.cells_of(results[place])) {
      if (of_table[cells.size()].width) {
        cells.emplace_back(std::move(cell));
      } else {
        cells.emplace_back(*number(cell));
      }
    }
    return cells;
  };
  write_table(of_table, results.size(), row, {{"format", "flinch campaign"}}, folder / "results.h5");
}

}  // namespace flinch
