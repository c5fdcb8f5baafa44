#include "systems/framework/table_file.h"

#include <algorithm>

#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_object.h"

namespace flinch {
namespace {

constexpr std::size_t block_rows = 1024;  // are written at once

std::size_t bytes_of_a_cell(const TableColumn& column) {
  return column.width ? std::max<std::size_t>(*column.width, 1) : sizeof(double);
}

std::size_t bytes_of_a_row(const std::vector<TableColumn>& columns) {
  std::size_t bytes = 0;
  for (const TableColumn& column : columns) bytes += bytes_of_a_cell(column);
  return bytes;
}

/// Puts a cell behind those that its column has so far; shorter texts are filled up with zeros.
void append(const TableCell& cell, const TableColumn& column, std::string& cells) {
  const auto* const text = std::get_if<std::string>(&cell);
  const std::size_t end = cells.size() + bytes_of_a_cell(column);
  if ((text != nullptr) != column.width.has_value() || (text != nullptr && text->size() > *column.width))
    throw SetupError("a cell of the column '" + column.name +
                     "' is not of its kind, or longer than its width");
  if (text != nullptr) {
    cells += *text;
  } else {
    cells.append(reinterpret_cast<const char*>(&std::get<double>(cell)), sizeof(double));
  }
  cells.resize(end, '\0');
}

}  // namespace

void write_table(const std::vector<TableColumn>& columns, std::size_t rows,
                 const std::function<std::vector<TableCell>(std::size_t row)>& row,
                 const std::map<std::string, std::string>& attributes, const std::filesystem::path& file) {
  internal::write_hdf5_result(file, rows * bytes_of_a_row(columns), [&](internal::Hdf5Object::Id table) {
    for (const auto& [name, text] : attributes) internal::write_text(table, name, text);
    std::vector<internal::Hdf5Object> sets;
    std::vector<std::string> blocks(columns.size());
    std::size_t first = 0;
    do {
      const std::size_t end = std::min(first + block_rows, rows);
      for (std::string& block : blocks) block.clear();
      for (std::size_t k = first; k < end; ++k) {
        const std::vector<TableCell> cells = row(k);
        for (std::size_t i = 0; i < columns.size(); ++i) append(cells.at(i), columns[i], blocks[i]);
      }
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (first == 0) sets.push_back(internal::make_column(table, columns[i].name, rows, columns[i].width));
        internal::write_cells(sets[i], first, end - first, blocks[i].data());
      }
      first = end;
    } while (first < rows);
  });
}

}  // namespace flinch
