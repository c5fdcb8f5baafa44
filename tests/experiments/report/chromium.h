#pragma once

#include <filesystem>

namespace flinch {

/// Chromium finds nothing wrong with the page at `path`; skips the test where Debian's chromium-driver is not
/// installed.
void expect_works_in_chromium(const std::filesystem::path& path);

}  // namespace flinch
