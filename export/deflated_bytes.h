#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace flinch {

/// Bytes that are compressed as they come.
class DeflatedBytes {
 public:
  enum class Form {
    raw,   ///< as zip files have them
    zlib,  ///< with head and checksum, as MATLAB files have them
  };

  explicit DeflatedBytes(Form form);
  ~DeflatedBytes();
  DeflatedBytes(DeflatedBytes&&) noexcept;
  DeflatedBytes& operator=(DeflatedBytes&&) noexcept;

  void add(const void* bytes, std::size_t size);
  /// The compressed bytes. Nothing may be added afterwards.
  const std::string& finish();

  std::size_t size_before() const;  ///< of what was added
  std::uint32_t checksum() const;   ///< CRC-32 of what was added

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace flinch
