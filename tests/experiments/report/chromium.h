#pragma once

#include <filesystem>

namespace flinch {

/// Chromium finds nothing wrong with the page at `path`, which `script`, a file below tests/experiments, uses
/// there; skips the test where Debian's chromium-driver is not installed.
void expect_works_in_chromium(const std::filesystem::path& path,
                              const char* script = "report/page_in_browser.py");

}  // namespace flinch
