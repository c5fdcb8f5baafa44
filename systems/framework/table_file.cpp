#include "systems/framework/table_file.h"

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

}  // namespace

void write_table(const std::vector<TableColumn>& columns,
                 const std::map<std::string, std::string>& attributes, const std::filesystem::path& file) {
  const std::filesystem::path other = file.string() + ".new";
  {
    const std::lock_guard lock(internal::hdf5_mutex());
    const internal::Hdf5Object table = internal::create_hdf5_file(other);
    for (const auto& [name, text] : attributes) internal::write_text(table, name, text);
    for (const TableColumn& column : columns) write_column(table, column);
    internal::flush_hdf5_file(table);
  }
  std::error_code error;
  std::filesystem::rename(other, file, error);
  if (error) throw SetupError(file.string() + ": the file cannot be written: " + error.message());
}

}  // namespace flinch
