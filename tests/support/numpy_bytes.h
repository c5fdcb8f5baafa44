#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace flinch::test {

/// An array as NumPy 1.24 writes it, version 1.0, head padded to 128 bytes.
template <class Number>
std::string npy(const std::string& descr, const std::string& shape, const std::vector<Number>& numbers,
                bool fortran = false) {
  std::string head = "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
                     ", 'shape': " + shape + ", }";
  head.resize(117, ' ');
  head += '\n';
  std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + std::string("\x76\x00", 2) + head;
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  return bytes;
}

inline void append(std::string& bytes, std::uint64_t number, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xff);
}

inline std::uint32_t crc(const std::string& bytes) {
  std::uint32_t sum = 0xffffffff;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int i = 0; i < 8; ++i) sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~sum;
}

/// An archive of stored files, by the description of the format (APPNOTE 6.3).
inline std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string bytes, directory;
  for (const auto& [name, content] : files) {
    const std::size_t at = bytes.size();
    std::string same;
    append(same, 20, 2), append(same, 0, 2), append(same, 0, 2), append(same, 0, 4);
    append(same, crc(content), 4), append(same, content.size(), 4), append(same, content.size(), 4);
    append(same, name.size(), 2), append(same, 0, 2);
    bytes += "PK\x03\x04" + same + name + content;
    directory += "PK\x01\x02";
    append(directory, 20, 2);
    directory += same;
    append(directory, 0, 2), append(directory, 0, 2), append(directory, 0, 2), append(directory, 0, 4);
    append(directory, at, 4);
    directory += name;
  }
  const std::size_t begin = bytes.size();
  bytes += directory + "PK\x05\x06";
  append(bytes, 0, 4), append(bytes, files.size(), 2), append(bytes, files.size(), 2);
  append(bytes, directory.size(), 4), append(bytes, begin, 4), append(bytes, 0, 2);
  return bytes;
}

}  // namespace flinch::test
