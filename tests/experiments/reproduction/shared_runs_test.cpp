#include "experiments/reproduction/shared_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/reproduction/paper_file.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(SharedRuns, KnowAllFilesKeysAndSignalsOfTheShippedFigures) {
  const PaperFigures all = read_paper_file(test::shipped("papers/papers.yaml"));
  EXPECT_NO_THROW(SharedRuns{all}) << "told before any run";
}

TEST(SharedRuns, DrawTheRunsOfACampaignByBody) {
  const test::Workplace place;
  place.write(
      "campaign.yaml",
      "scenarios: [{file: scenarios/platform_collision.yaml}, {file: scenarios/first_link_collision.yaml}]\n"
      "runs: 1\nseed: 1\n");
  place.write("figures.yaml", R"(pictures:
  - {id: a, source: A, title: t, x: x, y: y, dots: [
     {campaign: campaign.yaml, body: link1, x: removal_time_s, x_less: momentum_observer.detection_time_s,
      x_times: 1000, y: peak_force_N},
     {campaign: campaign.yaml, x: speed_m_per_s, y: peak_force_N}]}
)");
  const PaperFigures all = read_paper_file(place / "figures.yaml");
  const test::TemporaryFolder folder;
  SharedRuns runs(all);
  runs.run({.folder = folder.path()});
  const PicturePoints of_link = runs.dots(all.pictures[0].dots[0]);
  ASSERT_EQ(of_link.x.size(), 1U);
  EXPECT_NEAR(of_link.x[0], 42.0, 5.0) << "removed after the detection [ms], as docs/theory.md has it";
  EXPECT_EQ(runs.dots(all.pictures[0].dots[1]).y.size(), 2U);
}

TEST(SharedRuns, RefuseCommandsThatPrintNoJsonOrNoMatrix) {
  const test::TemporaryFolder folder;
  const PaperFigures all = read_paper_file(folder.write(
      "figures.yaml",
      "pictures: [{id: a, source: A, title: t, matrix: {commands: evaluate a, key: confusion}}]\n"));
  const auto problems = [&](const std::string& printed) {
    return test::problems_of([&] {
      SharedRuns runs(all);
      runs.run({.folder = folder.path(), .run_command = [&](const auto&, const auto&) { return printed; }});
      runs.matrix(*all.pictures[0].matrix);
    });
  };
  EXPECT_THAT(problems("a table"), ElementsAre(HasSubstr("write its --json")));
  EXPECT_THAT(problems("{}"), ElementsAre(HasSubstr("prints no matrix 'confusion'")));
  EXPECT_THAT(problems(R"({"confusion": {"classes": ["a"], "rows": [[1]]}})"), ElementsAre());
}

}  // namespace
}  // namespace flinch
