#include "import/matlab_elements.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "import/byte_order.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::uint64_t head = 128;  // bytes before the first element
constexpr std::uint64_t tag = 8;     // bytes before what an element holds: its type, its size
constexpr std::uint32_t matrix = 14, deflated = 15;
constexpr std::uint32_t cells = 1, structs = 2, objects = 3;  // classes of matrices that hold matrices
constexpr int most_levels = 20;                               // of matrices in matrices
constexpr std::uint32_t first_number = 6, last_number = 15;   // of classes
constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

struct Damaged {};

/// Of one number of a type; 1 of those that are no numbers.
std::uint64_t bytes_of(std::uint32_t type) {
  switch (type) {
    case 3:  // int16
    case 4:
      return 2;
    case 5:  // int32
    case 6:
    case 7:  // single
      return 4;
    case 9:   // double
    case 12:  // int64
    case 13:
      return 8;
    default:
      return 1;
  }
}

std::uint32_t number_at(const char* bytes, bool is_big) {
  return static_cast<std::uint32_t>(number_of_bytes({bytes, sizeof(std::uint32_t)}, is_big));
}

/// The bytes of a file from a place on, as they are or inflated.
class Source {
 public:
  Source(std::ifstream& stream, std::uint64_t size, bool is_deflated) : stream_(stream), left_(size) {
    if (!is_deflated) return;
    inflating_.emplace();
    if (inflateInit(&*inflating_) != Z_OK) throw Damaged{};
    read_.resize(1 << 16);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() {
    if (inflating_) inflateEnd(&*inflating_);
  }

  /// Throws Damaged where there are not as many.
  void take(char* bytes, std::size_t size) {
    if (inflating_) return inflate_to(bytes, size);
    if (size > left_ || !stream_.read(bytes, static_cast<std::streamsize>(size))) throw Damaged{};
    left_ -= size;
  }
  void skip(std::uint64_t size) {
    std::array<char, 1 << 14> unread;
    for (; size > 0; size -= std::min<std::uint64_t>(size, unread.size()))
      take(unread.data(), std::min<std::uint64_t>(size, unread.size()));
  }
  /// To its end, where the sum of what was deflated stands.
  void finish() {
    char over = 0;
    if (!inflating_ || has_ended_) return;
    inflating_->next_out = reinterpret_cast<Bytef*>(&over);
    inflating_->avail_out = 1;
    while (!has_ended_ && inflating_->avail_out > 0) inflate_once();
    if (!has_ended_) throw Damaged{};
  }

 private:
  void inflate_to(char* bytes, std::size_t size) {
    inflating_->next_out = reinterpret_cast<Bytef*>(bytes);
    inflating_->avail_out = static_cast<uInt>(size);
    while (inflating_->avail_out > 0) {
      if (has_ended_) throw Damaged{};
      inflate_once();
    }
  }
  void inflate_once() {
    if (inflating_->avail_in == 0) {
      const std::uint64_t part = std::min<std::uint64_t>(left_, read_.size());
      if (part == 0 || !stream_.read(read_.data(), static_cast<std::streamsize>(part))) throw Damaged{};
      left_ -= part;
      inflating_->next_in = reinterpret_cast<Bytef*>(read_.data());
      inflating_->avail_in = static_cast<uInt>(part);
    }
    const int result = inflate(&*inflating_, Z_NO_FLUSH);
    if (result != Z_OK && result != Z_STREAM_END) throw Damaged{};
    has_ended_ = result == Z_STREAM_END;
  }

  std::ifstream& stream_;
  std::uint64_t left_;  ///< bytes in the file
  std::optional<z_stream> inflating_;
  std::vector<char> read_;
  bool has_ended_ = false;
};

/// Goes through the elements of one variable.
class Walk {
 public:
  Walk(Source& source, bool is_big) : source_(source), is_big_(is_big) {}

  /// An element and what it holds; `most`: bytes that there are for it. Returns how many it took.
  std::uint64_t element(std::uint64_t most, int level) {
    std::array<char, tag> told{};
    if (most < tag) throw Damaged{};
    source_.take(told.data(), told.size());
    const std::uint32_t type = number(told.data());
    if (type >> 16U != 0) {  // up to 4 bytes stand in the tag
      read_ = 4;
      std::copy_n(told.data() + 4, read_, content_.begin());
      numbers_ = (type >> 16U) / bytes_of(type & 0xffffU);
      return tag;
    }
    const std::uint64_t size = number(told.data() + 4);
    const std::uint64_t padded = (size + 7) / 8 * 8;
    if (padded > most - tag) throw Damaged{};
    numbers_ = size / bytes_of(type);
    if (type == matrix)
      inside_matrix(padded, level + 1);
    else
      simple(padded);
    return tag + padded;
  }

 private:
  /// A matrix holds its class, its dimensions, its name, and then numbers or matrices.
  void inside_matrix(std::uint64_t size, int level) {
    if (level > most_levels) throw Damaged{};
    std::uint32_t kind = 0;
    std::uint64_t told = 0;
    for (int i = 0; size > 0; ++i) {
      size -= element(size, level);
      if (i == 0) kind = number(content_.data()) & 0xffU;
      if (i == 1) told = product();
      const bool holds_matrices = kind == cells || kind == structs || kind == objects;
      const bool holds_numbers = first_number <= kind && kind <= last_number;
      if (i == 1 && holds_matrices && told > size) throw Damaged{};
      if (i == 3 && holds_numbers && told != numbers_) throw Damaged{};
    }
  }

  /// Of the dimensions that were read last.
  std::uint64_t product() const {
    std::uint64_t product = 1;
    for (std::size_t at = 0; at + 4 <= read_ && product < (1U << 30U); at += 4)
      product *= number(content_.data() + at);
    return product;
  }

  void simple(std::uint64_t size) {
    read_ = static_cast<std::size_t>(std::min<std::uint64_t>(size, content_.size()));
    source_.take(content_.data(), read_);
    source_.skip(size - read_);
  }

  std::uint32_t number(const char* bytes) const { return number_at(bytes, is_big_); }

  Source& source_;
  bool is_big_;
  std::array<char, 128> content_{};  ///< the first bytes of the last element that holds no matrices
  std::size_t read_ = 0;             ///< how many of these
  std::uint64_t numbers_ = 0;        ///< in the last element
};

}  // namespace

void check_matlab_elements(const std::filesystem::path& file) {
  const std::uint64_t end = std::filesystem::file_size(file);
  std::ifstream stream(file, std::ios::binary);
  std::array<char, head> first{};
  stream.read(first.data(), first.size());
  const bool is_big = first[126] == 'M';
  for (std::uint64_t at = head, number = 1; at < end; ++number) {
    const std::string variable = "its variable number " + std::to_string(number);
    std::array<char, tag> told{};
    stream.seekg(static_cast<std::streamoff>(at));
    const bool has_tag = static_cast<bool>(stream.read(told.data(), told.size()));
    const bool is_deflated = number_at(told.data(), is_big) == deflated;
    const std::uint64_t size = number_at(told.data() + 4, is_big);
    if (!has_tag || at + tag + size > end)
      throw SetupError("the file is cut in " + variable + "; save it again");
    if (!is_deflated) stream.seekg(static_cast<std::streamoff>(at));
    try {
      Source source(stream, is_deflated ? size : tag + size, is_deflated);
      Walk(source, is_big).element(is_deflated ? unknown : tag + size, 0);
      source.finish();
    } catch (const Damaged&) {
      throw SetupError("the file is damaged in " + variable + "; save it again");
    }
    at += tag + size;
  }
}

}  // namespace flinch
