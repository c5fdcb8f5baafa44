#include "experiments/reproduction/reproduction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/experiments/report/chromium.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using Outcome = ReproducedFigure::Outcome;

PaperFigure figure_of(double paper, PaperFigure::Better better = PaperFigure::Better::lower) {
  PaperFigure figure;
  figure.id = "a.b";
  figure.source = "[A] Table I";
  figure.title = "time";
  figure.unit = "ms";
  figure.paper = paper;
  figure.better = better;
  return figure;
}

TEST(Reproduced, IsWhatThePapersMethodGivesWithinTheRatioEitherWay) {
  for (const double value : {10.0, 13.0, 10.0 / 1.3})
    EXPECT_EQ(judged(figure_of(10.0, PaperFigure::Better::neither), value, {}).outcome, Outcome::reproduced);
  for (const double value : {13.1, 7.6, -10.0})
    EXPECT_EQ(judged(figure_of(10.0, PaperFigure::Better::neither), value, {}).outcome, Outcome::not_reached);
  EXPECT_EQ(judged(figure_of(0.0), 0.0, {}).outcome, Outcome::reproduced);
}

TEST(Better, IsWhatIsAsGoodByEitherMethodAndNotReproduced) {
  EXPECT_EQ(judged(figure_of(10.0), 5.0, {}).outcome, Outcome::better);
  EXPECT_EQ(judged(figure_of(10.0), 20.0, 9.0).outcome, Outcome::better);
  EXPECT_EQ(judged(figure_of(10.0), 20.0, 11.0).outcome, Outcome::not_reached);
  EXPECT_EQ(judged(figure_of(10.0, PaperFigure::Better::higher), 20.0, {}).outcome, Outcome::better);
  EXPECT_EQ(judged(figure_of(10.0), 11.0, 4.0).outcome, Outcome::reproduced) << "says more of the method";
}

TEST(NotReached, IsWhatNothingCameOutOf) {
  EXPECT_EQ(judged(figure_of(10.0), std::nullopt, std::nullopt).outcome, Outcome::not_reached);
}

TEST(ReproductionPage, IsReadableAtEveryWidthAndOnPaper) {
  const std::vector<ReproducedFigure> figures = {judged(figure_of(10.0), 5.0, 4.0),
                                                 judged(figure_of(0.127), std::nullopt, 1234.5)};
  const test::TemporaryFolder folder;
  expect_works_in_chromium(
      folder.write("page.html", reproduction_page(figures, "flinch reproduce --only a.b")),
      "report/still_page_in_browser.py");
}

TEST(Reproduction, RunsEachScenarioOnceAndTakesItsFiguresFromItsJson) {
  const test::Workplace place;
  place.write("figures.yaml", R"(figures:
  - {id: p.detection, source: '[A] T1', title: one, unit: ms, paper: 10, better: lower,
     as_printed: {scenario: scenarios/platform_collision.yaml, figure: 'contacts[0].detection_ms'}}
  - {id: p.reaction, source: '[A] T1', title: two, unit: ms, paper: 44,
     as_printed: {scenario: scenarios/platform_collision.yaml, figure: 'contacts[0].removal_ms',
                  less: 'contacts[0].detection_ms'},
     ours: {scenario: scenarios/platform_collision.yaml, set: [{key: duration_s, value: 0.4}],
            figure: 'contacts[0].removal_ms'}}
)");
  const test::TemporaryFolder folder;
  double last = 0.0;
  const auto figures =
      reproduce(read_paper_figures(place / "figures.yaml"), folder.path(), 2, [&](double share) {
        last = share;
        return true;
      });
  ASSERT_EQ(figures.size(), 2U);
  ASSERT_TRUE(figures[0].as_printed && figures[1].as_printed);
  EXPECT_NEAR(*figures[0].as_printed, 11.9, 0.3) << "as docs/theory.md has it";
  EXPECT_NEAR(*figures[1].as_printed, 71.0, 3.0);
  EXPECT_FALSE(figures[1].ours) << "it ends before the contact";
  EXPECT_LE(last, 1.0);
  const auto json = nlohmann::json::parse(reproduction_json(figures));
  EXPECT_EQ(json["entries"][0]["id"], "p.detection");
  EXPECT_EQ(json["entries"][0]["verdict"], "reproduced");
  EXPECT_EQ(json["entries"][1]["ours"], nullptr);
  EXPECT_THAT(reproduction_table(figures), HasSubstr("2 figures: 1 reproduced, 0 better, 1 not reached"));
  EXPECT_THAT(reproduction_page(figures, "flinch reproduce"), HasSubstr("\"id\":\"p.reaction\""));
}

TEST(Reproduction, RunsCampaignsFromTheirFoldersOn) {
  const test::Workplace place;
  place.write("campaign.yaml", "scenarios: [{file: scenarios/platform_collision.yaml}]\nruns: 2\nseed: 1\n");
  place.write("figures.yaml", R"(figures:
  - {id: c, source: '[A] T1', title: one, paper: 12,
     as_printed: {campaign: campaign.yaml, figure: 'groups[body=platform].median_ms'}}
)");
  const test::TemporaryFolder folder;
  const auto figures = read_paper_figures(place / "figures.yaml");
  const auto first = reproduce(figures, folder.path());
  EXPECT_EQ(first.front().outcome, Outcome::reproduced);
  EXPECT_EQ(reproduce(figures, folder.path()).front().as_printed, first.front().as_printed);
}

TEST(Reproduction, TellsAllThatIsWrongBeforeAnyRun) {
  const test::Workplace place;
  place.replace("scenarios/clamping.yaml", "seed: 1", "seed: one");
  place.replace("scenarios/square.yaml", "duration_s", "duration");
  place.write("figures.yaml", R"(figures:
  - {id: a, source: A, title: one, paper: 1, as_printed: {scenario: scenarios/clamping.yaml, figure: a}}
  - {id: b, source: A, title: one, paper: 1, as_printed: {scenario: scenarios/square.yaml, figure: a}}
)");
  const test::TemporaryFolder folder;
  const auto problems =
      test::problems_of([&] { reproduce(read_paper_figures(place / "figures.yaml"), folder.path()); });
  EXPECT_THAT(problems, Contains(HasSubstr("clamping.yaml")));
  EXPECT_THAT(problems, Contains(HasSubstr("square.yaml")));
}

}  // namespace
}  // namespace flinch
