#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "systems/framework/fields.h"

namespace flinch {

/// Some samples of a recording, one after the other, in memory of somebody else.
struct SampleBlock {
  std::span<const std::int64_t> time_ns;
  std::vector<std::span<const internal::Number>> rows;  ///< of each signal of the recording, in its order

  std::size_t samples() const { return time_ns.size(); }
};

}  // namespace flinch
