#pragma once

#include <cstddef>

#include "systems/framework/recording.h"

namespace flinch {

/// A page with more samples takes long to open.
inline constexpr std::size_t most_page_samples = 10'000;

/// How many samples of the recording one of its page stands for.
std::size_t samples_in_one(const Recording& recording);

/// The samples of `recording` that a page shows, in memory: all, or of so many together the one with the
/// hardest contact, the first where there is none. `recording` may lie in a file; little of it is in memory
/// at a time.
Recording page_samples(const Recording& recording);

}  // namespace flinch
