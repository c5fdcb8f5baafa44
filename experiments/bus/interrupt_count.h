#pragma once

#include <functional>

namespace flinch {

/// Tells how often somebody has asked a program to end, as by Ctrl-C. It is called from the loop: it neither
/// blocks, allocates nor throws.
using InterruptCount = std::function<int()>;

/// Nobody ever does.
inline int no_interrupts() noexcept { return 0; }

}  // namespace flinch
