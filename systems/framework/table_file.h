#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace flinch {

/// A column of a table: numbers, where "no data" is not a number, or texts.
struct TableColumn {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::string>> values;
};

/// Writes a table to an HDF5 file, a dataset a column, first under another name. Equal tables make equal
/// files. Throws SetupError when that fails.
void write_table(const std::vector<TableColumn>& columns,
                 const std::map<std::string, std::string>& attributes, const std::filesystem::path& file);

}  // namespace flinch
