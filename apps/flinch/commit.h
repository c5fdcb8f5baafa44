#pragma once

#include <string_view>

namespace flinch {

/// The commit that this program was built from, "a1d5420", with "-dirty" where files differ from it; "" where
/// that is not known. Written by cmake/commit.cmake.
extern const std::string_view commit;

}  // namespace flinch
