#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace flinch {

/// A file in a zip archive.
struct ZipEntry {
  std::string name;
  std::uint64_t offset = 0;    ///< of its head in the archive
  std::uint64_t packed = 0;    ///< bytes in the archive
  std::uint64_t size = 0;      ///< bytes as it was
  std::uint32_t checksum = 0;  ///< CRC-32 of these
  std::uint16_t method = 0;    ///< 0 stored, 8 deflated
};

/// Whether a file begins as an archive does.
bool is_zip(const std::filesystem::path& file);

/// The files of an archive, in its order. Throws SetupError, without the name of the archive, where it is cut
/// or claims more than deflate can pack.
std::vector<ZipEntry> zip_entries(const std::filesystem::path& file);

/// The first bytes of one of them, all by default; checked against its CRC where they are all. Throws
/// SetupError, without the name of the archive, where it is broken or packed in another way.
std::string unzipped(const std::filesystem::path& file, const ZipEntry& entry,
                     std::uint64_t most = UINT64_MAX);

}  // namespace flinch
