#pragma once

#include <cstring>
#include <string>

#include "systems/framework/recording.h"

namespace flinch::test {

/// Whether all numbers of a signal are the same bits, at the same times.
inline bool is_same(const Recording& a, const Recording& b, const std::string& path) {
  const auto& rows_a = a.signal(path).rows;
  const auto& rows_b = b.signal(path).rows;
  return a.time_ns == b.time_ns && rows_a.size() == rows_b.size() &&
         std::memcmp(rows_a.data(), rows_b.data(), rows_a.size() * sizeof(rows_a[0])) == 0;
}

}  // namespace flinch::test
