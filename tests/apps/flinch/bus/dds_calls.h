#pragma once

#include <cstdint>

namespace flinch::test {

/// How often this thread has called what Cyclone DDS offers once everything is set up: to write, to take, to
/// ask who is there.
std::int64_t dds_calls();

}  // namespace flinch::test
