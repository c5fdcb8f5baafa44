#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

namespace flinch {

/// Appends a number as its bytes lie in memory: the lowest first, on the machines that flinch is built for.
template <class Number>
requires std::is_arithmetic_v<Number>
void append_bytes(Number number, std::string& bytes) {
  char text[sizeof number];
  std::memcpy(text, &number, sizeof number);
  bytes.append(text, sizeof number);
}

}  // namespace flinch
