// flinch graph: its page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/flinch/program.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

TEST(GraphVerb, MakesAPageThatIsSearchedAndFolded) {
  const test::Workplace place;
  const test::Outcome outcome =
      test::flinch({"graph", place.at("scenarios/platform_collision.yaml"), "--out", place.at("loop.html")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "graph: " + place.at("loop.html") + "\n");
  expect_works_in_chromium(place / "loop.html", "graph/graph_in_browser.py");
}

}  // namespace
}  // namespace flinch
