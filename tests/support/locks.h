#pragma once

#include <cstdint>

namespace flinch::test {

/// How many mutexes this thread has asked for since it started. Under a sanitizer this stays 0.
std::int64_t locks();

}  // namespace flinch::test
