#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "import/log_file.h"

namespace flinch {

/// A file of MATLAB, level 5, as `save` writes it with -v6 or -v7, and Octave and SciPy as well: each matrix
/// of numbers is a column, "current", or several, "current[0]" and on; fields of structs are "run.current",
/// of several structs "run[0].current". The longer dimension are the rows. Matrices of one struct with as
/// many rows are one table. Files of level 7.3 are HDF5 and are read as such.
class MatlabLog final : public LogFile {
 public:
  /// Throws SetupError naming the file and what is missing or broken.
  explicit MatlabLog(const std::filesystem::path& file);

  std::vector<std::vector<double>> read(std::span<const std::size_t> wanted, std::size_t most_rows) override;
  std::vector<std::int64_t> read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) override;

 private:
  /// Where a column lies.
  struct Place {
    std::string variable;           ///< of the file
    std::vector<std::size_t> path;  ///< from there on: element and field of a struct, and so on
    std::size_t column = 0;
  };
  class Visitor;

  template <class Take>
  void visit_columns(std::span<const std::size_t> wanted, const Take& take) const;

  std::vector<Place> places_;
};

bool is_matlab(const std::filesystem::path& file);

}  // namespace flinch
