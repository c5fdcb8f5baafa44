#pragma once

#include <cstddef>
#include <string>

#include "systems/framework/fields.h"
#include "systems/framework/hdf5_chunks.h"
#include "systems/framework/hdf5_object.h"

namespace flinch::internal {

/// Makes a table of numbers that rows can be appended to, compressed in chunks of `chunk_rows`.
Hdf5Object make_table(Hdf5Object::Id parent, const std::string& name, Field::Kind kind, std::size_t columns,
                      std::size_t chunk_rows);
/// A table of numbers that was opened.
struct Table {
  Hdf5Object set;
  std::size_t rows = 0;
  CheckedChunks chunks = {};
};
/// Trusts nothing that the file says of the table: numbers of `kind` in so many columns, in this file, no
/// more of them than its bytes can hold.
Table open_table(Hdf5Object::Id parent, const std::string& name, Field::Kind kind, std::size_t columns);
/// Appends `rows` rows after the first `at`.
void append_rows(Hdf5Object::Id table, Field::Kind kind, std::size_t at, std::size_t rows,
                 std::size_t columns, const Number* numbers);
void read_rows(Table& table, Field::Kind kind, std::size_t first, std::size_t rows, std::size_t columns,
               Number* numbers);

/// Rows that were taken out of a table, to be unpacked while others may use HDF5.
struct TakenRows {
  std::vector<StoredChunk> chunks{};  ///< one after the other; none: the numbers are there
  std::vector<Number> numbers{};

  /// Writes all their numbers. Throws SetupError where a chunk is no good.
  void unpack(Number* to) const;
};
TakenRows take_rows(Table& table, Field::Kind kind, std::size_t first, std::size_t rows, std::size_t columns);

}  // namespace flinch::internal
