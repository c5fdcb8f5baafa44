#pragma once

#include <cstdint>

namespace flinch::test {

/// A domain that nobody else on this machine uses, by the ports that its first participants would take, and
/// that no other test is given while this program lives.
std::uint32_t free_domain();

}  // namespace flinch::test
