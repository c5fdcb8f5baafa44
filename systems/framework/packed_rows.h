#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace flinch::internal {

/// Rows of 8-byte numbers, wherever they lie.
struct RowsInMemory {
  const char* first;
  std::size_t numbers;  ///< in a row
  std::size_t stride;   ///< from the beginning of a row to that of the next [bytes]
};

/// Packs rows of numbers into fewer bytes: of each number the bits that differ from the row before, first
/// bytes first, deflated. Numbers that hardly change from row to row take hardly any room.
class RowPacker {
 public:
  RowPacker();
  ~RowPacker();
  RowPacker(const RowPacker&) = delete;
  RowPacker& operator=(const RowPacker&) = delete;

  /// Appends `samples` rows to `bytes`. Throws SetupError where there is not enough memory.
  void pack(const RowsInMemory& rows, std::size_t samples, std::string& bytes);

 private:
  struct Deflation;
  std::unique_ptr<Deflation> deflation_;
  std::vector<unsigned char> planes_;
};

/// Unpacks `samples` rows of so many numbers, one behind the other. Throws SetupError where `packed` does not
/// hold exactly those; what it claims is not believed.
std::vector<char> unpacked_rows(std::string_view packed, std::size_t samples, std::size_t numbers);

}  // namespace flinch::internal
