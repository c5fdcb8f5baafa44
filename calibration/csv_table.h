#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace flinch {

/// Columns of a log, such as a file of comma-separated values whose first row names them.
struct CsvTable {
  std::vector<std::string> names;  ///< of the columns that were asked for, each once
  Eigen::MatrixXd values;          ///< rows x these columns
  int first_row = 2;               ///< as people count the rows of the file

  /// Index of the column `name`; -1: it was not asked for.
  int find(const std::string& name) const;
};

/// The names, each once, in the order in which they come first.
std::vector<std::string> each_once(const std::vector<std::string>& names);

/// Reads the columns `wanted`, of which a number takes 8 bytes; nothing else of the file stays in memory, and
/// no more than a row of it is there at a time. Throws SetupError naming file, row, counted from 1 with the
/// header, and column of what is missing or no number; the first few of each.
CsvTable read_csv(const std::filesystem::path& file, char separator, const std::vector<std::string>& wanted);

}  // namespace flinch
