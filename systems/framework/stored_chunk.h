#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "systems/framework/fields.h"

namespace flinch::internal {

/// What was deflated, exactly so many bytes and one more. Throws SetupError where there are fewer or more;
/// memory is taken only for what `packed` can hold.
std::vector<unsigned char> inflated(std::span<const unsigned char> packed, std::size_t bytes);

/// Rows of a data set as they lie in a file: shuffled and deflated, a piece for each chunk. They are taken
/// out of the file while nobody else uses HDF5, and unpacked without it. What a file claims is not believed.
struct StoredChunk {
  std::vector<unsigned char> packed;
  std::size_t rows = 0;  ///< of the whole chunk
  std::size_t columns = 0;
  std::size_t bytes_of_number = 8;  ///< 8; 1 of a boolean
  std::size_t first = 0;            ///< row of the chunk that is wanted first
  std::size_t count = 0;            ///< of the rows that are wanted

  /// Writes count x columns numbers. Throws SetupError where the chunk does not unpack to its full size.
  void unpack(Number* numbers) const;
};

}  // namespace flinch::internal
