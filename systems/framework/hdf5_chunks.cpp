#include "systems/framework/hdf5_chunks.h"

#include <hdf5.h>

#include <algorithm>
#include <span>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch::internal {
namespace {

/// The filters that have packed a data set, in the order in which they did.
std::vector<H5Z_filter_t> filters_of(hid_t creation) {
  std::vector<H5Z_filter_t> filters;
  for (int i = 0; i < H5Pget_nfilters(creation); ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    filters.push_back(
        H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, nullptr));
  }
  return filters;
}

/// Where a chunk lies in the file.
struct ChunkPlace {
  hsize_t place[2];  ///< of its first number
  hsize_t bytes = 0;
  unsigned skipped = 0;  ///< a bit for each filter that was not applied
  bool is_there = false;
};

/// Throws where it claims to take more than `most` bytes.
ChunkPlace chunk_at(Hdf5Object::Id table, hsize_t row, hsize_t column, std::size_t most) {
  ChunkPlace chunk{{row, column}};
  haddr_t address = HADDR_UNDEF;
  check(H5Dget_chunk_info_by_coord(table, chunk.place, &chunk.skipped, &address, &chunk.bytes),
        "finding a chunk");
  if (chunk.bytes > most)
    throw SetupError("a chunk claims to take " + std::to_string(chunk.bytes) + " bytes, more than the file");
  chunk.is_there = address != HADDR_UNDEF;
  return chunk;
}

std::vector<unsigned char> packed_bytes(Hdf5Object::Id table, const ChunkPlace& chunk) {
  std::vector<unsigned char> packed(chunk.bytes);
  std::uint32_t mask = 0;
  check(H5Dread_chunk(table, H5P_DEFAULT, chunk.place, &mask, packed.data()), "reading a chunk");
  return packed;
}

/// Throws unless the chunk unpacks to `size` bytes.
void check_unpacked(Hdf5Object::Id table, const ChunkPlace& chunk, const std::vector<H5Z_filter_t>& filters,
                    std::size_t size) {
  constexpr std::size_t sum = 4;  // that a filter of checksums appends
  std::size_t within = size, around = 0;
  bool is_deflated = false;
  for (std::size_t i = 0; i < filters.size(); ++i) {
    if ((chunk.skipped >> i & 1U) != 0) continue;
    if (filters[i] == H5Z_FILTER_DEFLATE) is_deflated = true;
    if (filters[i] == H5Z_FILTER_FLETCHER32) (is_deflated ? around : within) += sum;
  }
  if (is_deflated && chunk.bytes > around) {
    const std::vector<unsigned char> packed = packed_bytes(table, chunk);
    inflated(std::span(packed).first(packed.size() - around), within);
  } else if (chunk.bytes != within) {
    throw SetupError("a chunk does not unpack to the " + std::to_string(within) +
                     " bytes that it should have");
  }
}

}  // namespace

void check_layout(Hdf5Object::Id table, const std::string& name) {
  const Hdf5Object creation(H5Dget_create_plist(table), H5Pclose, "reading the layout of '" + name + "'");
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL || H5Pget_external_count(creation) != 0) refuse(name, "lies in other files");
  bool is_deflated = false;
  for (const H5Z_filter_t filter : filters_of(creation)) {
    if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_FLETCHER32) {
      refuse(name, "is packed by the filter " + std::to_string(filter) + ", which flinch does not use");
    }
    if (is_deflated && filter != H5Z_FILTER_FLETCHER32) refuse(name, "is packed again after it was deflated");
    is_deflated = is_deflated || filter == H5Z_FILTER_DEFLATE;
  }
  if (layout != H5D_CHUNKED) return;
  hsize_t chunk[2] = {0, 1};
  constexpr hsize_t largest = 1 << 23;  // numbers: 4096 rows of 2048
  const int rank = H5Pget_chunk(creation, 2, chunk);
  if (rank < 1 || rank > 2 || chunk[0] > largest || chunk[1] > largest || chunk[0] * chunk[1] > largest) {
    refuse(name, "has chunks of more than " + std::to_string(largest) + " numbers");
  }
}

void check_storage(Hdf5Object::Id table, const std::string& name, std::size_t rows, std::size_t columns) {
  constexpr std::size_t most_packed = 1100;  // deflate packs at most 1032 bytes into one
  constexpr std::size_t slack = 1 << 16;
  const std::size_t stored = std::min<std::size_t>(H5Dget_storage_size(table), file_size(table));
  if (rows > (slack + most_packed * stored) / sizeof(Number) / std::max<std::size_t>(columns, 1)) {
    refuse(name, "claims " + std::to_string(rows) + " samples, more than its " + std::to_string(stored) +
                     " bytes can hold");
  }
}

std::vector<StoredChunk> taken_chunks(Hdf5Object::Id table, Hdf5Object::Id type, std::size_t first,
                                      std::size_t rows, std::size_t columns) {
  const Hdf5Object creation(H5Dget_create_plist(table), H5Pclose, "reading how a data set was made");
  hsize_t size[2] = {0, 0};
  if (H5Pget_layout(creation) != H5D_CHUNKED || H5Pget_chunk(creation, 2, size) != 2 || size[1] != columns)
    return {};
  const Hdf5Object stored(H5Dget_type(table), H5Tclose, "reading the type of a data set");
  if (H5Tequal(stored, type) <= 0) return {};
  if (filters_of(creation) != std::vector<H5Z_filter_t>{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}) return {};
  const std::size_t most = file_size(table), length = size[0];
  std::vector<StoredChunk> chunks;
  for (std::size_t row = first; row < first + rows;) {
    const std::size_t begin = row / length * length, end = std::min(begin + length, first + rows);
    const ChunkPlace place = chunk_at(table, begin, 0, most);
    if (!place.is_there || place.skipped != 0) return {};
    StoredChunk& chunk = chunks.emplace_back();
    chunk.packed = packed_bytes(table, place);
    chunk.rows = length;
    chunk.columns = columns;
    chunk.bytes_of_number = H5Tget_size(stored);
    chunk.first = row - begin;
    chunk.count = end - row;
    row = end;
  }
  return chunks;
}

void CheckedChunks::require(Hdf5Object::Id table, std::size_t first, std::size_t rows, std::size_t columns) {
  const Hdf5Object creation(H5Dget_create_plist(table), H5Pclose, "reading how a data set was made");
  hsize_t chunk[2] = {1, 1};
  if (H5Pget_layout(creation) != H5D_CHUNKED || H5Pget_chunk(creation, 2, chunk) < 1) return;
  const Hdf5Object type(H5Dget_type(table), H5Tclose, "reading the type of a data set");
  const std::size_t size = chunk[0] * chunk[1] * H5Tget_size(type), most = file_size(table);
  const std::vector<H5Z_filter_t> filters = filters_of(creation);
  for (hsize_t row = first / chunk[0] * chunk[0]; row < first + rows; row += chunk[0]) {
    const std::size_t number = row / chunk[0];
    if (number >= good_.size()) good_.resize(number + 1);
    if (good_[number]) continue;
    for (hsize_t column = 0; column < columns; column += chunk[1]) {
      const ChunkPlace stored = chunk_at(table, row, column, most);
      if (stored.is_there) check_unpacked(table, stored, filters, size);
    }
    good_[number] = true;
  }
}

}  // namespace flinch::internal
