#include "experiments/reproduction/figure_path.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace flinch {
namespace {

const nlohmann::json run = nlohmann::json::parse(R"({
  "max_tracking_error_mm": 4.5, "fault": "",
  "contacts": [{"detection_ms": 11.5, "by": {"observer": 3}}, {"detection_ms": null}],
  "groups": [{"body": "platform", "n": 6, "at": {"gain": 20}, "median_ms": 7.0},
             {"body": "platform", "n": 6, "at": {"gain": 100}, "median_ms": 5.0},
             {"body": "link1", "n": 5, "at": {"gain": 20}, "median_ms": 9.0}]})");

TEST(FigurePath, LeadsThroughKeysAndNumbersOfEntries) {
  EXPECT_EQ(figure_at(run, "max_tracking_error_mm"), 4.5);
  EXPECT_EQ(figure_at(run, "contacts[0].detection_ms"), 11.5);
  EXPECT_EQ(figure_at(run, "contacts[0].by.observer"), 3.0);
}

TEST(FigurePath, ChoosesTheFirstEntryWithTheseValues) {
  EXPECT_EQ(figure_at(run, "groups[body=link1].median_ms"), 9.0);
  EXPECT_EQ(figure_at(run, "groups[body=platform, n=6].median_ms"), 7.0);
  EXPECT_EQ(figure_at(run, "groups[body=platform, gain=100].median_ms"), 5.0)
      << "where it stands in the grid";
}

TEST(FigurePath, TakesTheMostTheLeastOrTheSumOfAllThatFit) {
  EXPECT_EQ(figure_at(run, "most groups.median_ms"), 9.0);
  EXPECT_EQ(figure_at(run, "least groups[body=platform].median_ms"), 5.0);
  EXPECT_EQ(figure_at(run, "sum groups.n"), 17.0);
  EXPECT_EQ(figure_at(run, "sum groups[body=platform].n"), 12.0);
}

TEST(FigurePath, FindsNothingWhereThereIsNoNumber) {
  for (const char* const path : {"contacts[1].detection_ms", "contacts[2].detection_ms", "fault", "contacts",
                                 "groups[body=link2].median_ms", "max_tracking_error_mm.x", "nothing"})
    EXPECT_FALSE(figure_at(run, path)) << path;
}

TEST(FigurePath, SaysWhatIsNoPath) {
  EXPECT_EQ(problem_with_path("most groups[body=link1, n=5].median_ms"), "");
  for (const char* const path :
       {"", ".", "a..b", "a[", "a[]", "a[b]", "a[=1]", "a]", "a b", "a[1]b", "[0].a", "a."})
    EXPECT_NE(problem_with_path(path), "") << path;
}

}  // namespace
}  // namespace flinch
