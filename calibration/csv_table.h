#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace flinch {

/// Columns of a file of comma-separated values whose first row names them.
struct CsvTable {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< rows x columns; those that were not asked for are not a number

  /// Index of the column `name`; -1: there is none.
  int find(const std::string& name) const;
};

/// Reads the columns `wanted`. Throws SetupError naming file, row, counted from 1 with the header, and column
/// of what is missing or no number; the first few of each.
CsvTable read_csv(const std::filesystem::path& file, char separator, const std::vector<std::string>& wanted);

}  // namespace flinch
