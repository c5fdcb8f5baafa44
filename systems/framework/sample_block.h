#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "systems/framework/fields.h"

namespace flinch {

/// The rows of one signal, one a sample, in memory of somebody else.
struct SampleRows {
  const internal::Number* first;
  std::size_t numbers;  ///< in a row
  std::size_t stride;   ///< from the beginning of a row to that of the next

  std::span<const internal::Number> operator[](std::size_t sample) const {
    return {first + sample * stride, numbers};
  }
};

/// Some samples of a recording, one after the other, in memory of somebody else.
struct SampleBlock {
  std::span<const std::int64_t> time_ns;
  std::vector<SampleRows> rows;  ///< of each signal of the recording, in its order

  std::size_t samples() const { return time_ns.size(); }
  /// `count` of them, from `begin` on.
  SampleBlock part(std::size_t begin, std::size_t count) const {
    SampleBlock part{time_ns.subspan(begin, count), rows};
    for (SampleRows& each : part.rows) each.first += begin * each.stride;
    return part;
  }
};

}  // namespace flinch
