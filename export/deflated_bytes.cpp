#include "export/deflated_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

namespace flinch {

struct DeflatedBytes::Stream {
  z_stream zlib{};
  std::string compressed;
  std::size_t size = 0;
  uLong checksum = crc32(0, nullptr, 0);

  void run(int flush) {
    std::array<unsigned char, 1 << 15> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    do {
      zlib.next_out = buffer.data();
      zlib.avail_out = static_cast<uInt>(buffer.size());
      deflate(&zlib, flush);
      compressed.append(reinterpret_cast<const char*>(buffer.data()), buffer.size() - zlib.avail_out);
    } while (zlib.avail_out == 0);
  }
};

DeflatedBytes::DeflatedBytes(Form form) : stream_(std::make_unique<Stream>()) {
  const int window = form == Form::raw ? -15 : 15;
  deflateInit2(&stream_->zlib, Z_BEST_SPEED, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
}

DeflatedBytes::~DeflatedBytes() {
  if (stream_) deflateEnd(&stream_->zlib);
}
DeflatedBytes::DeflatedBytes(DeflatedBytes&&) noexcept = default;
DeflatedBytes& DeflatedBytes::operator=(DeflatedBytes&&) noexcept = default;

void DeflatedBytes::add(const void* bytes, std::size_t size) {
  const auto* next = static_cast<const unsigned char*>(bytes);
  while (size > 0) {
    const auto part = static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
    stream_->checksum = crc32(stream_->checksum, next, part);
    stream_->zlib.next_in = const_cast<unsigned char*>(next);  // which zlib does not write
    stream_->zlib.avail_in = part;
    stream_->run(Z_NO_FLUSH);
    stream_->size += part;
    next += part;
    size -= part;
  }
}

const std::string& DeflatedBytes::finish() {
  stream_->zlib.avail_in = 0;
  stream_->run(Z_FINISH);
  return stream_->compressed;
}

std::size_t DeflatedBytes::size_before() const { return stream_->size; }
std::uint32_t DeflatedBytes::checksum() const { return static_cast<std::uint32_t>(stream_->checksum); }

}  // namespace flinch
