#include "import/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string_view>

#include "import/byte_order.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::uint64_t end_size = 22;            // of the record at the end of an archive
constexpr std::uint64_t longest_comment = 65535;  // behind it
constexpr std::uint64_t entry_size = 46;          // of an entry of the directory, without its texts
constexpr std::uint64_t head_size = 30;           // of a file, likewise
constexpr std::uint64_t most_deflate = 1100;      // times: more it cannot pack, and something
constexpr std::size_t most_entries = 10'000;

/// Little-endian numbers out of bytes, of which there must be enough.
template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  if (at + sizeof(Number) > bytes.size()) throw SetupError("the archive is cut");
  return static_cast<Number>(number_of_bytes(std::string_view(bytes).substr(at, sizeof(Number))));
}

std::string bytes_at(std::ifstream& stream, std::uint64_t at, std::uint64_t size) {
  std::string bytes(size, '\0');
  stream.clear();
  stream.seekg(static_cast<std::streamoff>(at));
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) throw SetupError("the archive is cut");
  return bytes;
}

/// Where the directory lies.
struct Directory {
  std::uint64_t at = 0, size = 0;
  std::size_t entries = 0;
};

Directory directory_of(std::ifstream& stream, std::uint64_t length) {
  const std::uint64_t looked_at = std::min(length, end_size + longest_comment);
  const std::string end = bytes_at(stream, length - looked_at, looked_at);
  const std::size_t found = end.rfind("PK\x05\x06");
  if (found == std::string::npos)
    throw SetupError("the archive is cut: its directory, at the end, is missing");
  const Directory directory{number_at<std::uint32_t>(end, found + 16),
                            number_at<std::uint32_t>(end, found + 12),
                            number_at<std::uint16_t>(end, found + 10)};
  if (directory.at + directory.size > length)
    throw SetupError("the archive is larger than 4 GB, or its directory is broken");
  if (directory.entries > most_entries) throw SetupError("the archive has more than 10,000 files");
  return directory;
}

class Inflater {
 public:
  Inflater() {
    if (inflateInit2(&stream_, -MAX_WBITS) != Z_OK) throw SetupError("zlib cannot begin");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// As many bytes as `size` says.
  std::string all(std::string packed, std::uint64_t size) {
    std::string bytes;
    stream_.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream_.avail_in = static_cast<uInt>(packed.size());
    std::string block(std::min<std::uint64_t>(size, 1U << 20U), '\0');
    while (bytes.size() < size) {
      stream_.next_out = reinterpret_cast<Bytef*>(block.data());
      stream_.avail_out = static_cast<uInt>(block.size());
      const int status = inflate(&stream_, Z_NO_FLUSH);
      const std::size_t made = block.size() - stream_.avail_out;
      bytes.append(block.data(), std::min<std::uint64_t>(made, size - bytes.size()));
      if (status == Z_STREAM_END || made == 0) break;
      if (status != Z_OK) throw SetupError("what is packed is broken");
    }
    if (bytes.size() < size) throw SetupError("what is packed ends too soon");
    return bytes;
  }

 private:
  z_stream stream_{};
};

}  // namespace

bool is_zip(const std::filesystem::path& file) {
  std::string head(4, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), 4);
  return stream && (head == std::string("PK\x03\x04") || head == std::string("PK\x05\x06"));
}

std::vector<ZipEntry> zip_entries(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(0, std::ios::end);
  const auto length = static_cast<std::uint64_t>(stream.tellg());
  const Directory directory = directory_of(stream, length);
  const std::string bytes = bytes_at(stream, directory.at, directory.size);
  std::vector<ZipEntry> entries;
  std::size_t at = 0;
  for (std::size_t i = 0; i < directory.entries; ++i) {
    if (bytes.compare(at, 4, "PK\x01\x02") != 0) throw SetupError("the directory of the archive is broken");
    const auto name = number_at<std::uint16_t>(bytes, at + 28),
               extra = number_at<std::uint16_t>(bytes, at + 30),
               comment = number_at<std::uint16_t>(bytes, at + 32);
    ZipEntry entry{.name = bytes.substr(at + entry_size, name),
                   .offset = number_at<std::uint32_t>(bytes, at + 42),
                   .packed = number_at<std::uint32_t>(bytes, at + 20),
                   .size = number_at<std::uint32_t>(bytes, at + 24),
                   .checksum = number_at<std::uint32_t>(bytes, at + 16),
                   .method = number_at<std::uint16_t>(bytes, at + 10)};
    if (entry.offset + head_size + entry.packed > length || entry.size > most_deflate * entry.packed + 64)
      throw SetupError("'" + entry.name + "' claims more bytes than the archive can hold");
    entries.push_back(std::move(entry));
    at += entry_size + name + extra + comment;
  }
  return entries;
}

std::string unzipped(const std::filesystem::path& file, const ZipEntry& entry, std::uint64_t most) {
  std::ifstream stream(file, std::ios::binary);
  const std::string head = bytes_at(stream, entry.offset, head_size);
  if (head.compare(0, 4, "PK\x03\x04") != 0)
    throw SetupError("'" + entry.name + "' is not where the directory says");
  const std::uint64_t begin =
      entry.offset + head_size + number_at<std::uint16_t>(head, 26) + number_at<std::uint16_t>(head, 28);
  const std::uint64_t size = std::min(entry.size, most);
  std::string bytes;
  if (entry.method == 0) {
    if (entry.packed != entry.size) throw SetupError("'" + entry.name + "' is stored with two sizes");
    bytes = bytes_at(stream, begin, size);
  } else if (entry.method == 8) {
    bytes = Inflater().all(bytes_at(stream, begin, entry.packed), size);
  } else {
    throw SetupError("'" + entry.name + "' is packed by the method " + std::to_string(entry.method) +
                     "; only stored and deflated files are read");
  }
  const bool is_whole = size == entry.size;
  if (is_whole && crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != entry.checksum)
    throw SetupError("'" + entry.name + "' is broken: its checksum is another");
  return bytes;
}

}  // namespace flinch
