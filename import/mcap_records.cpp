#include "import/mcap_records.h"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <memory>

#include "import/byte_order.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::uint64_t most_of_record = 1ULL << 30U;  // bytes in memory
constexpr unsigned char schema_record = 0x03, channel_record = 0x04, message_record = 0x05,
                        chunk_record = 0x06, data_end_record = 0x0F;

/// Bytes that are taken from the front.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : left_(bytes) {}

  bool empty() const { return left_.empty(); }
  std::string_view rest() const { return left_; }
  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) throw SetupError("a record ends before what it announces");
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }
  /// The lowest byte first.
  template <class Number>
  Number number() {
    return static_cast<Number>(number_of_bytes(take(sizeof(Number))));
  }
  std::string text() { return std::string(take(number<std::uint32_t>())); }

 private:
  std::string_view left_;
};

std::string of_lz4(std::string_view bytes, std::uint64_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
    throw SetupError("LZ4 cannot begin");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
      context, &LZ4F_freeDecompressionContext);
  std::string whole(size, '\0');
  std::size_t written = 0;
  while (written < size && !bytes.empty()) {
    std::size_t out = size - written, in = bytes.size();
    const std::size_t result =
        LZ4F_decompress(context, whole.data() + written, &out, bytes.data(), &in, nullptr);
    if (LZ4F_isError(result) || (out == 0 && in == 0)) break;
    written += out;
    bytes.remove_prefix(in);
  }
  if (written != size) throw SetupError("a chunk compressed by LZ4 is damaged");
  return whole;
}

std::string of_zstandard(std::string_view bytes, std::uint64_t size) {
  std::string whole(size, '\0');
  const std::size_t written = ZSTD_decompress(whole.data(), whole.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(written) || written != size)
    throw SetupError("a chunk compressed by Zstandard is damaged");
  return whole;
}

class Reader {
 public:
  Reader(const std::function<void(const McapChannel&)>& on_channel,
         const std::function<void(std::uint16_t, std::uint64_t, std::string_view)>& on_message)
      : on_channel_(on_channel), on_message_(on_message) {}

  void record(unsigned char kind, std::string_view content) {
    Bytes bytes(content);
    switch (kind) {
      case schema_record:
        return schema(bytes);
      case channel_record:
        return channel(bytes);
      case message_record:
        return message(bytes);
      case chunk_record:
        return chunk(bytes);
      default:  // an index, or what a later version knows
        return;
    }
  }

 private:
  void schema(Bytes& bytes) {
    const auto id = bytes.number<std::uint16_t>();
    schemas_[id] = bytes.text();
  }
  void channel(Bytes& bytes) {
    McapChannel channel;
    channel.id = bytes.number<std::uint16_t>();
    channel.schema = schemas_[bytes.number<std::uint16_t>()];
    channel.topic = bytes.text();
    channel.encoding = bytes.text();
    if (channels_.emplace(channel.id, true).second) on_channel_(channel);  // chunks say it again
  }
  void message(Bytes& bytes) {
    const auto id = bytes.number<std::uint16_t>();
    bytes.number<std::uint32_t>();  // of the message in its channel
    const auto logged = bytes.number<std::uint64_t>();
    bytes.number<std::uint64_t>();  // when it was published
    if (channels_.count(id) == 0) throw SetupError("a message belongs to no channel");
    on_message_(id, logged, bytes.rest());
  }
  void chunk(Bytes& bytes) {
    bytes.take(2 * sizeof(std::uint64_t));  // the times of its messages
    const auto size = bytes.number<std::uint64_t>();
    const auto sum = bytes.number<std::uint32_t>();
    const std::string compression = bytes.text();
    const std::string_view packed = bytes.take(bytes.number<std::uint64_t>());
    if (size > most_of_record) throw SetupError("a chunk has more than 1 GB");
    if (compression.empty()) return records(packed, sum);
    if (compression != "lz4" && compression != "zstd")
      throw SetupError("a chunk is compressed by '" + compression + "'; lz4 and zstd are known");
    records(compression == "lz4" ? of_lz4(packed, size) : of_zstandard(packed, size), sum);
  }
  void records(std::string_view content, std::uint32_t sum) {
    const uLong own = crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size());
    if (sum != 0 && own != sum) throw SetupError("a chunk is damaged: it has another sum");
    for (Bytes bytes(content); !bytes.empty();) {
      const auto kind = bytes.number<unsigned char>();
      const std::string_view inside = bytes.take(bytes.number<std::uint64_t>());
      if (kind != chunk_record) record(kind, inside);
    }
  }

  const std::function<void(const McapChannel&)>& on_channel_;
  const std::function<void(std::uint16_t, std::uint64_t, std::string_view)>& on_message_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, bool> channels_;
};

}  // namespace

std::vector<std::string> read_mcap(const std::filesystem::path& file,
                                   const std::function<void(const McapChannel&)>& on_channel,
                                   const std::function<void(std::uint16_t channel, std::uint64_t logged_ns,
                                                            std::string_view bytes)>& on_message) {
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t left = std::filesystem::file_size(file) - magic.size();
  stream.seekg(static_cast<std::streamoff>(magic.size()));
  Reader reader(on_channel, on_message);
  std::string content;
  for (;;) {
    std::array<char, 9> head{};
    if (left < head.size() || !stream.read(head.data(), head.size())) break;
    Bytes bytes(std::string_view(head.data(), head.size()));
    const auto kind = bytes.number<unsigned char>();
    const auto size = bytes.number<std::uint64_t>();
    left -= head.size();
    if (kind == data_end_record) return {};
    if (size > left) break;
    if (size > most_of_record) throw SetupError("a record has more than 1 GB");
    content.resize(size);
    if (!stream.read(content.data(), static_cast<std::streamsize>(size))) break;
    left -= size;
    reader.record(kind, content);
  }
  return {"it ends too early, as its writer was killed or a copy was cut; what is there was read"};
}

bool is_mcap(const std::filesystem::path& file) {
  std::string head(magic.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return stream && head == magic;
}

}  // namespace flinch
