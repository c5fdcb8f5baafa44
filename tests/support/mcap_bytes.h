#pragma once

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

/// Bags of ROS 2 by hand: the bytes that the specifications of MCAP and of CDR say.
namespace flinch::test {

template <class Number>
std::string little(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}
inline std::string mcap_text(const std::string& text) {
  return little(static_cast<std::uint32_t>(text.size())) + text;
}
inline std::string mcap_record(unsigned char kind, const std::string& content) {
  return std::string(1, static_cast<char>(kind)) + little(std::uint64_t{content.size()}) + content;
}
inline std::string mcap_schema(std::uint16_t id, const std::string& type) {
  return mcap_record(3, little(id) + mcap_text(type) + mcap_text("ros2msg") + mcap_text("float64 x"));
}
inline std::string mcap_channel(std::uint16_t id, std::uint16_t schema, const std::string& topic,
                                const std::string& encoding = "cdr") {
  return mcap_record(
      4, little(id) + little(schema) + mcap_text(topic) + mcap_text(encoding) + little(std::uint32_t{0}));
}
inline std::string mcap_message(std::uint16_t channel, std::uint64_t logged, const std::string& content) {
  return mcap_record(5,
                     little(channel) + little(std::uint32_t{1}) + little(logged) + little(logged) + content);
}
inline std::string mcap_chunk(const std::string& records, const std::string& compression) {
  std::string packed = records;
  if (compression == "zstd") {
    packed.resize(ZSTD_compressBound(records.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 1));
  } else if (compression == "lz4") {
    packed.resize(LZ4F_compressFrameBound(records.size(), nullptr));
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), records.data(), records.size(), nullptr));
  }
  const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size());
  return mcap_record(6, little(std::uint64_t{0}) + little(std::uint64_t{9}) +
                            little(std::uint64_t{records.size()}) + little(static_cast<std::uint32_t>(sum)) +
                            mcap_text(compression) + little(std::uint64_t{packed.size()}) + packed);
}
inline std::string mcap_file(const std::string& records) {
  const std::string magic("\x89MCAP0\r\n", 8);
  return magic + mcap_record(1, mcap_text("ros2") + mcap_text("by hand")) + records +
         mcap_record(15, little(std::uint32_t{0})) + mcap_record(2, std::string(20, '\0')) + magic;
}

/// A message of ROS 2, with the lowest byte of each number first.
class CdrMessage {
 public:
  /// std_msgs/msg/Header
  CdrMessage(std::int32_t seconds, std::uint32_t nanoseconds) {
    add(seconds).add(nanoseconds).add(std::string("base"));
  }

  template <class Number>
  CdrMessage& add(Number number) {
    align(sizeof number);
    content_ += little(number);
    return *this;
  }
  CdrMessage& add(const std::string& text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    content_ += text + '\0';
    return *this;
  }
  template <class Value>
  CdrMessage& add(const std::vector<Value>& values) {
    add(static_cast<std::uint32_t>(values.size()));
    for (const Value& value : values) add(value);
    return *this;
  }
  std::string bytes() const { return std::string("\0\1\0\0", 4) + content_; }

 private:
  void align(std::size_t size) { content_.resize((content_.size() + size - 1) / size * size, '\0'); }

  std::string content_;
};

}  // namespace flinch::test
