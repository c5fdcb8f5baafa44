#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "systems/framework/hdf5_object.h"

/// HDF5 files of other tools, which are asked what they hold. All throw SetupError saying what failed;
/// whoever calls them holds hdf5_mutex().
namespace flinch::internal {

/// A data set of numbers as its file describes it.
struct ForeignShape {
  std::string name;  ///< path from the root, "/log/current"
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<std::string> members{};  ///< of a compound, those that are numbers; its columns are 1 then
  std::string unit{};                  ///< its attribute "unit" or "units"
  bool is_integer = false;
  bool is_alias = false;  ///< a symbolic link leads there
};

/// What a file holds.
struct ForeignContents {
  std::vector<ForeignShape> tables;   ///< in the order of their names
  std::vector<std::string> left_out;  ///< data sets that are none, with the reason
};

/// Opens a file that another program has written. Where that was killed and has left the mark that it still
/// writes, a copy in memory is opened without it, and `was_left_open` says so.
Hdf5Object open_foreign_file(const std::filesystem::path& file, bool& was_left_open);

ForeignContents contents_of(Hdf5Object::Id file);

/// Rows of numbers of whatever type, in one column or several. Trusts nothing that the file says of them.
struct ForeignTable {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> numbers;  ///< row by row
};
/// `member`: of a compound; "" of a data set of numbers.
ForeignTable read_foreign_table(Hdf5Object::Id parent, const std::string& name,
                                const std::string& member = "");
/// The same of whole numbers, exactly.
std::vector<std::int64_t> read_foreign_integers(Hdf5Object::Id parent, const std::string& name,
                                                const std::string& member = "");

}  // namespace flinch::internal
