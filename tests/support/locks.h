#pragma once

#include <cstdint>

namespace flinch::test {

/// How many mutexes this thread has asked for since it started. Under a sanitizer this stays 0.
std::int64_t locks();

/// Whether this program runs under a sanitizer, which replaces much of the C library.
bool sanitized();

}  // namespace flinch::test
