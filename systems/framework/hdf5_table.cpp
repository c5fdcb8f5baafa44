#include "systems/framework/hdf5_table.h"

#include <hdf5.h>

#include <algorithm>

#include "systems/foundation/setup_error.h"

namespace flinch::internal {
namespace {

hid_t file_type(Field::Kind kind) {
  if (kind == Field::Kind::real) return H5T_IEEE_F64LE;
  return kind == Field::Kind::boolean ? H5T_STD_U8LE : H5T_STD_I64LE;
}

hid_t memory_type(Field::Kind kind) {
  return kind == Field::Kind::real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
}

/// The rows first ... first + rows of a table, in the file; and as they lie in memory.
struct Selection {
  Hdf5Object in_file;
  Hdf5Object in_memory;
};

Selection select(hid_t table, std::size_t first, std::size_t rows, std::size_t columns) {
  const hsize_t start[2] = {first, 0}, size[2] = {rows, columns};
  Selection selection{{H5Dget_space(table), H5Sclose, "reading the size of a data set"},
                      {H5Screate_simple(2, size, nullptr), H5Sclose, "making a data space"}};
  check(H5Sselect_hyperslab(selection.in_file, H5S_SELECT_SET, start, nullptr, size, nullptr),
        "choosing rows of a data set");
  return selection;
}

/// Throws unless the numbers of a table convert to those of `kind`.
void check_type(hid_t table, const std::string& name, Field::Kind kind) {
  const Hdf5Object type(H5Dget_type(table), H5Tclose, "reading the type of '" + name + "'");
  const H5T_class_t wanted = kind == Field::Kind::real ? H5T_FLOAT : H5T_INTEGER;
  if (H5Tget_class(type) != wanted || H5Tget_size(type) > sizeof(Number)) {
    refuse(name, kind == Field::Kind::real ? "has no real numbers" : "has no integers");
  }
}

}  // namespace

Hdf5Object make_table(Hdf5Object::Id parent, const std::string& name, Field::Kind kind, std::size_t columns,
                      std::size_t chunk_rows) {
  const hsize_t none[2] = {0, columns}, most[2] = {H5S_UNLIMITED, columns}, chunk[2] = {chunk_rows, columns};
  const Hdf5Object space(H5Screate_simple(2, none, most), H5Sclose, "making a data space");
  const Hdf5Object creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "making data set properties");
  check(H5Pset_obj_track_times(creation, false), "leaving out time stamps");
  check(H5Pset_chunk(creation, 2, chunk), "chunking");
  check(H5Pset_shuffle(creation), "shuffling");
  check(H5Pset_deflate(creation, 1), "compressing");
  const Hdf5Object access = without_chunk_cache();
  return {H5Dcreate2(parent, name.c_str(), file_type(kind), space, H5P_DEFAULT, creation, access), H5Dclose,
          "making the data set '" + name + "'"};
}

Table open_table(Hdf5Object::Id parent, const std::string& name, Field::Kind kind, std::size_t columns) {
  Hdf5Object table = open_data_set(parent, name);
  check_type(table, name, kind);
  const Hdf5Object space(H5Dget_space(table), H5Sclose, "reading the size of '" + name + "'");
  hsize_t size[2] = {0, 0};
  if (H5Sget_simple_extent_ndims(space) != 2 || H5Sget_simple_extent_dims(space, size, nullptr) != 2) {
    refuse(name, "is no table of rows and columns");
  }
  if (size[1] != columns) {
    refuse(name, "has " + std::to_string(size[1]) + " columns instead of " + std::to_string(columns));
  }
  check_layout(table, name);
  check_storage(table, name, size[0], columns);
  return {std::move(table), size[0], {}};
}

void append_rows(Hdf5Object::Id table, Field::Kind kind, std::size_t at, std::size_t rows,
                 std::size_t columns, const Number* numbers) {
  const hsize_t size[2] = {at + rows, columns};
  check(H5Dset_extent(table, size), "growing a data set");
  const Selection selection = select(table, at, rows, columns);
  check(H5Dwrite(table, memory_type(kind), selection.in_memory, selection.in_file, H5P_DEFAULT, numbers),
        "writing a data set");
}

void read_rows(Table& table, Field::Kind kind, std::size_t first, std::size_t rows, std::size_t columns,
               Number* numbers) {
  silence_hdf5();
  table.chunks.require(table.set, first, rows, columns);
  const Selection selection = select(table.set, first, rows, columns);
  check(H5Dread(table.set, memory_type(kind), selection.in_memory, selection.in_file, H5P_DEFAULT, numbers),
        "reading a data set");
}

void TakenRows::unpack(Number* to) const {
  if (chunks.empty()) std::copy(numbers.begin(), numbers.end(), to);
  for (const StoredChunk& chunk : chunks) {
    chunk.unpack(to);
    to += chunk.count * chunk.columns;
  }
}

TakenRows take_rows(Table& table, Field::Kind kind, std::size_t first, std::size_t rows,
                    std::size_t columns) {
  silence_hdf5();
  TakenRows taken{taken_chunks(table.set, file_type(kind), first, rows, columns)};
  if (!taken.chunks.empty()) return taken;
  taken.numbers.resize(rows * columns);
  read_rows(table, kind, first, rows, columns, taken.numbers.data());
  return taken;
}

}  // namespace flinch::internal
