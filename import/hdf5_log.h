#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "import/log_file.h"

namespace flinch {

/// An HDF5 file of another tool: each data set of numbers is a column, "/log/time", one of several columns is
/// that many, "/log/current[0]" and on, and each number of a compound is one, "/log.time". Row vectors, as
/// MATLAB writes them, are columns. Data sets in one group with as many rows are one table.
class Hdf5Log final : public LogFile {
 public:
  /// Throws SetupError naming the file and what is missing or broken.
  explicit Hdf5Log(const std::filesystem::path& file);

  std::size_t find(const std::string& name) const override;
  std::vector<std::vector<double>> read(std::span<const std::size_t> wanted, std::size_t most_rows) override;
  std::vector<std::int64_t> read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) override;

 private:
  /// Where a column lies.
  struct Place {
    std::string set;
    std::string member;
    std::size_t column = 0;
    bool is_integer = false;
  };
  std::vector<Place> places_;
};

bool is_hdf5(const std::filesystem::path& file);

}  // namespace flinch
