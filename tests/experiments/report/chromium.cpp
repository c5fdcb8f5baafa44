#include "tests/experiments/report/chromium.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace flinch {

void expect_works_in_chromium(const std::filesystem::path& path, const char* script) {
  const auto file = std::filesystem::path(FLINCH_SOURCE_DIR) / "tests/experiments" / script;
  const int status = std::system(("python3 '" + file.string() + "' '" + path.string() + "'").c_str());
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "there is no chromedriver";
  EXPECT_EQ(status, 0);
}

}  // namespace flinch
