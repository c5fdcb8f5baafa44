#include "apps/flinch/man_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "tests/apps/flinch/program.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ManPage, HasEveryVerbWithItsOptions) {
  const test::Outcome page = test::flinch({"man"});
  EXPECT_EQ(page.status, 0);
  EXPECT_THAT(page.out, AllOf(HasSubstr(".TH FLINCH 1"), HasSubstr(".SS flinch reproduce\n"),
                              HasSubstr(".SS flinch calibrate thresholds\n"), HasSubstr("\\fB\\-\\-only\\fR"),
                              HasSubstr(".SH EXIT STATUS")));
}

TEST(ManPage, ShowsDotsQuotesAndBackslashesThatBeginALine) {
  CLI::App app(".a\n'b\\c", "x");
  EXPECT_THAT(man_page(app, "1"), HasSubstr("\\&.a\n\\&'b\\ec\n"));
}

}  // namespace
}  // namespace flinch
