#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace flinch {

/// A column of a table: of numbers, where "no data" is not a number, or of texts.
struct TableColumn {
  std::string name;
  std::optional<std::size_t> width = std::nullopt;  ///< bytes of the longest text; none: numbers
};

using TableCell = std::variant<double, std::string>;

/// Writes a table to an HDF5 file, a dataset a column, first under another name. `row` is asked for the cells
/// of one row after the other, so that a long table takes no more memory than a short one. Equal tables make
/// equal files. Throws SetupError when that fails, and where a cell does not fit its column.
void write_table(const std::vector<TableColumn>& columns, std::size_t rows,
                 const std::function<std::vector<TableCell>(std::size_t row)>& row,
                 const std::map<std::string, std::string>& attributes, const std::filesystem::path& file);

}  // namespace flinch
