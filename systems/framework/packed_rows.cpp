#include "systems/framework/packed_rows.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "systems/foundation/setup_error.h"

namespace flinch::internal {
namespace {

constexpr std::size_t word_size = 8;
constexpr std::size_t most_packed = 1100;  // deflate packs at most 1032 bytes into one

/// What differs of each number from the row before, one plane for each byte of each number.
void split(const RowsInMemory& rows, std::size_t samples, std::vector<unsigned char>& planes) {
  planes.resize(samples * rows.numbers * word_size);
  for (std::size_t number = 0; number < rows.numbers; ++number) {
    unsigned char* const plane = planes.data() + number * word_size * samples;
    std::uint64_t before = 0;
    for (std::size_t k = 0; k < samples; ++k) {
      std::uint64_t word = 0;
      std::memcpy(&word, rows.first + k * rows.stride + number * word_size, word_size);
      const std::uint64_t differing = word ^ before;
      before = word;
      for (std::size_t byte = 0; byte < word_size; ++byte)
        plane[byte * samples + k] = static_cast<unsigned char>(differing >> (8 * byte));
    }
  }
}

void join(const std::vector<unsigned char>& planes, std::size_t samples, std::size_t numbers,
          std::vector<char>& rows) {
  rows.resize(planes.size());
  for (std::size_t number = 0; number < numbers; ++number) {
    const unsigned char* const plane = planes.data() + number * word_size * samples;
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < samples; ++k) {
      for (std::size_t byte = 0; byte < word_size; ++byte)
        word ^= static_cast<std::uint64_t>(plane[byte * samples + k]) << (8 * byte);
      std::memcpy(rows.data() + (k * numbers + number) * word_size, &word, word_size);
    }
  }
}

[[noreturn]] void refuse() { throw SetupError("a frame does not unpack to the samples that it claims"); }

/// Whether `bytes` unpack to all of `planes` and no more.
bool inflate_into(std::string_view bytes, std::vector<unsigned char>& planes) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw SetupError("there is not enough memory to unpack a frame");
  stream.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes.data()));  // zlib only reads it
  stream.avail_in = static_cast<unsigned>(bytes.size());
  stream.next_out = planes.data();
  stream.avail_out = static_cast<unsigned>(planes.size());
  const int status = inflate(&stream, Z_FINISH);
  const bool is_whole = status == Z_STREAM_END && stream.avail_out == 0 && stream.avail_in == 0;
  inflateEnd(&stream);
  return is_whole;
}

}  // namespace

struct RowPacker::Deflation {
  z_stream stream{};
};

RowPacker::RowPacker() : deflation_(std::make_unique<Deflation>()) {
  if (deflateInit(&deflation_->stream, Z_BEST_SPEED) != Z_OK)
    throw SetupError("there is not enough memory to pack samples");
}

RowPacker::~RowPacker() { deflateEnd(&deflation_->stream); }

void RowPacker::pack(const RowsInMemory& rows, std::size_t samples, std::string& bytes) {
  split(rows, samples, planes_);
  z_stream& stream = deflation_->stream;
  deflateReset(&stream);
  const std::size_t begin = bytes.size();
  bytes.resize(begin + deflateBound(&stream, planes_.size()));
  stream.next_in = planes_.data();
  stream.avail_in = static_cast<unsigned>(planes_.size());
  stream.next_out = reinterpret_cast<unsigned char*>(bytes.data() + begin);
  stream.avail_out = static_cast<unsigned>(bytes.size() - begin);
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw SetupError("samples cannot be packed");
  bytes.resize(begin + stream.total_out);
}

std::vector<char> unpacked_rows(std::string_view packed, std::size_t samples, std::size_t numbers) {
  constexpr std::size_t most = std::numeric_limits<unsigned>::max() / 2;
  if (packed.size() > most || samples > most || numbers > most) refuse();
  if (samples * numbers > std::min(packed.size() * most_packed, most) / word_size) refuse();
  if (samples * numbers == 0) return {};
  std::vector<unsigned char> planes(samples * numbers * word_size);
  if (!inflate_into(packed, planes)) refuse();
  std::vector<char> rows;
  join(planes, samples, numbers, rows);
  return rows;
}

}  // namespace flinch::internal
