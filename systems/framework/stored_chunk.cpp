#include "systems/framework/stored_chunk.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <string>

#include "systems/foundation/setup_error.h"

namespace flinch::internal {
namespace {

constexpr std::size_t most_deflated = 1032;  // bytes that deflate packs into one, at most

static_assert(std::endian::native == std::endian::little, "chunks hold numbers that begin with the low byte");

}  // namespace

std::vector<unsigned char> inflated(std::span<const unsigned char> packed, std::size_t bytes) {
  const auto refuse = [bytes] {
    throw SetupError("a chunk does not unpack to the " + std::to_string(bytes) +
                     " bytes that it should have");
  };
  if (bytes > most_deflated * packed.size()) refuse();  // before memory is taken for them
  std::vector<unsigned char> unpacked(bytes + 1);       // one more tells that there is more
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw SetupError("a chunk cannot be unpacked");
  stream.next_in = const_cast<unsigned char*>(packed.data());  // zlib only reads it
  stream.avail_in = static_cast<unsigned>(packed.size());
  stream.next_out = unpacked.data();
  stream.avail_out = static_cast<unsigned>(unpacked.size());
  const bool is_whole = inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.total_out == bytes;
  inflateEnd(&stream);
  if (!is_whole) refuse();
  return unpacked;
}

void StoredChunk::unpack(Number* numbers) const {
  const std::size_t in_all = rows * columns, wanted = count * columns;
  const std::vector<unsigned char> planes = inflated(packed, in_all * bytes_of_number);
  const unsigned char* const begin = planes.data() + first * columns;  // of the plane of the first bytes
  if (bytes_of_number == 1) {
    for (std::size_t i = 0; i < wanted; ++i) numbers[i].integer = begin[i];
    return;
  }
  for (std::size_t i = 0; i < wanted; ++i) {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < 8; ++byte)
      bits |= static_cast<std::uint64_t>(begin[byte * in_all + i]) << (8 * byte);
    std::memcpy(&numbers[i], &bits, sizeof bits);
  }
}

}  // namespace flinch::internal
