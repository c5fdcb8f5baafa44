#include "systems/framework/table_file.h"

#include <algorithm>

#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_object.h"

namespace flinch {
namespace {

void write_column(internal::Hdf5Object::Id file, const TableColumn& column) {
  if (const auto* const texts = std::get_if<std::vector<std::string>>(&column.values)) {
    internal::write_texts(file, column.name, *texts);
    return;
  }
  const auto& numbers = std::get<std::vector<double>>(column.values);
  internal::write_reals(file, column.name, numbers);
}

std::size_t bytes_of(const std::vector<TableColumn>& columns) {
  std::size_t bytes = 0;
  for (const TableColumn& column : columns) {
    if (const auto* const texts = std::get_if<std::vector<std::string>>(&column.values)) {
      std::size_t width = 1;
      for (const std::string& text : *texts) width = std::max(width, text.size());
      bytes += width * texts->size();
    } else {
      bytes += std::get<std::vector<double>>(column.values).size() * sizeof(double);
    }
  }
  return bytes;
}

}  // namespace

void write_table(const std::vector<TableColumn>& columns,
                 const std::map<std::string, std::string>& attributes, const std::filesystem::path& file) {
  internal::write_hdf5_result(file, bytes_of(columns), [&](internal::Hdf5Object::Id table) {
    for (const auto& [name, text] : attributes) internal::write_text(table, name, text);
    for (const TableColumn& column : columns) write_column(table, column);
  });
}

}  // namespace flinch
