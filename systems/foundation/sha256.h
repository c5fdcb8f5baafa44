#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace flinch {

/// The SHA-256 of bytes that come in pieces. [FIPS 180-4]
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// Of all bytes so far, as 64 hexadecimal digits, as the program sha256sum prints it.
  std::string digits() const;

 private:
  using State = std::array<std::uint32_t, 8>;
  static void mix(const unsigned char* block, State& state);

  State state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                  0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> rest_{};  // what fills no block yet
  std::uint64_t length_ = 0;              // [bytes]
};

/// The same of bytes that are all there.
std::string sha256(std::string_view bytes);

/// The same of the bytes of a file, as far as it can be read.
std::string sha256_of(const std::filesystem::path& file);

}  // namespace flinch
