#include "experiments/reproduction/reproduction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/reproduction/paper_file.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
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
  Reproduction figures;
  figures.figures = {judged(figure_of(10.0), 5.0, 4.0), judged(figure_of(0.127), std::nullopt, 1234.5)};
  PaperPicture picture;
  picture.id = "a.c";
  picture.source = "[A] Table I";
  picture.title = "force over time";
  picture.x_title = "time, ms";
  picture.y_title = "force, N";
  picture.lines.resize(2);
  picture.lines[0].name = "one";
  picture.dots.resize(1);
  picture.dots[0].with_line = true;
  picture.marks = {{"limit", 140.0, false}, {"start", 0.0, true}};
  PicturePoints many;
  for (int k = 0; k < 5000; ++k) {
    many.x.push_back(1e-3 * k);
    many.y.push_back(k == 2500 ? 200.0 : 0.01 * k);
  }
  PaperPicture matrix;
  matrix.id = "a.d";
  matrix.source = "[A] Table I";
  matrix.title = "what was told";
  matrix.matrix.emplace();
  const PictureShares shares{{"platform", "leg1_link1"}, {{0.9, 0.1}, {0.0, 1.0}}};
  figures.pictures = {{picture, {many, {}}, {{{1.0, 2.0, 3.0}, {1.0, 4.0, 5.0}}}, {}},
                      {matrix, {}, {}, shares}};
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
  const Reproduction reproduction =
      reproduce(read_paper_file(place / "figures.yaml"),
                {.folder = folder.path(), .threads = 2, .progress = [&](double share) {
                   last = share;
                   return true;
                 }});
  const auto& figures = reproduction.figures;
  ASSERT_EQ(figures.size(), 2U);
  ASSERT_TRUE(figures[0].as_printed && figures[1].as_printed);
  EXPECT_NEAR(*figures[0].as_printed, 11.9, 0.3) << "as docs/theory.md has it";
  EXPECT_NEAR(*figures[1].as_printed, 71.0, 3.0);
  EXPECT_FALSE(figures[1].ours) << "it ends before the contact";
  EXPECT_LE(last, 1.0);
  const auto json = nlohmann::json::parse(reproduction_json(reproduction));
  EXPECT_EQ(json["entries"][0]["id"], "p.detection");
  EXPECT_EQ(json["entries"][0]["verdict"], "reproduced");
  EXPECT_EQ(json["entries"][1]["ours"], nullptr);
  EXPECT_THAT(reproduction_table(reproduction),
              HasSubstr("2 figures: 1 reproduced, 0 better, 1 not reached"));
  EXPECT_THAT(reproduction_page(reproduction, "flinch reproduce"), HasSubstr("\"id\":\"p.reaction\""));
}

TEST(Reproduction, RunsCampaignsFromTheirFoldersOn) {
  const test::Workplace place;
  place.write("campaign.yaml", "scenarios: [{file: scenarios/platform_collision.yaml}]\nruns: 2\nseed: 1\n");
  place.write("figures.yaml", R"(figures:
  - {id: c, source: '[A] T1', title: one, paper: 12,
     as_printed: {campaign: campaign.yaml, figure: 'groups[body=platform].median_ms'}}
)");
  const test::TemporaryFolder folder;
  const PaperFigures figures = read_paper_file(place / "figures.yaml");
  const auto first = reproduce(figures, {.folder = folder.path()}).figures;
  EXPECT_EQ(first.front().outcome, Outcome::reproduced);
  EXPECT_EQ(reproduce(figures, {.folder = folder.path()}).figures.front().as_printed,
            first.front().as_printed);
}

TEST(Reproduction, TakesFiguresAndLinesOfTheRecording) {
  const test::Workplace place;
  place.write("figures.yaml", R"(figures:
  - {id: force, source: A, title: peak, unit: N, paper: 1,
     as_printed: {scenario: scenarios/platform_collision.yaml, figure: 'contacts[0].peak_force_N'},
     ours: {scenario: scenarios/platform_collision.yaml, take: largest,
            curve: {since_contact: true,
              length_of: 'contact.strongest.force_in_base[0], contact.strongest.force_in_base[1]'}}}
  - {id: ratio, source: A, title: ratio, unit: '%', paper: 1,
     as_printed: {scenario: scenarios/platform_collision.yaml, figure: 'contacts[0].peak_force_N',
                  per: 'contacts[0].limit_N', times: 100}}
pictures:
  - {id: motion, source: A, title: path, x: 'x, mm', y: 'y, mm',
     lines: [{scenario: scenarios/platform_collision.yaml,
              curve: {of: 'motion.pose[1]', times: 1000, to_s: 0.5},
              over: {of: 'motion.pose[0]', times: 1000}}]}
)");
  const test::TemporaryFolder folder;
  const Reproduction got = reproduce(read_paper_file(place / "figures.yaml"), {.folder = folder.path()});
  ASSERT_TRUE(got.figures[0].as_printed && got.figures[0].ours && got.figures[1].as_printed);
  EXPECT_NEAR(*got.figures[0].as_printed, *got.figures[0].ours, 0.01 * *got.figures[0].ours)
      << "the verdict has the peak of the plant's steps, the recording that of its ticks";
  EXPECT_NEAR(*got.figures[1].as_printed, *got.figures[0].as_printed / 2.8, 1e-9);
  ASSERT_EQ(got.pictures.size(), 1U);
  const PicturePoints& path = got.pictures[0].lines[0];
  EXPECT_GT(path.x.size(), 490U);
  EXPECT_EQ(path.x.size(), path.y.size());
}

TEST(Reproduction, NamesANumberThatNoRecordingHasAndAColumnThatNoTableHas) {
  const test::Workplace place;
  place.write("campaign.yaml", "scenarios: [{file: scenarios/platform_collision.yaml}]\nruns: 1\nseed: 1\n");
  const std::string head = "pictures:\n  - {id: a, source: A, title: t, x: x, y: y, ";
  place.write(
      "line.yaml",
      head + "lines: [{scenario: scenarios/platform_collision.yaml, curve: {of: 'motoin.pose[1]'}}]}\n");
  place.write("dots.yaml", head + "dots: [{campaign: campaign.yaml, x: speed_m_per_s, y: peek_force_N}]}\n");
  const test::TemporaryFolder folder;
  const auto problems = [&](const char* file) {
    return test::problems_of([&] { reproduce(read_paper_file(place / file), {.folder = folder.path()}); });
  };
  EXPECT_THAT(problems("line.yaml"), Contains(HasSubstr("did you mean 'motion'")));
  EXPECT_THAT(problems("dots.yaml"), Contains(HasSubstr("did you mean 'peak_force_N'")));
}

TEST(Reproduction, RunsACommandThatFiguresShareOnceAndTheirLastOneEach) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("figures.yaml", R"(figures:
  - {id: a, source: A, title: one, paper: 1, as_printed: {commands: 'make data && ask one', figure: n}}
  - {id: b, source: A, title: two, paper: 1, as_printed: {commands: 'make data && ask two', figure: n}}
)");
  std::vector<std::string> called;
  const Reproduction got = reproduce(
      read_paper_file(file),
      {.folder = folder.path(), .run_command = [&](const std::vector<std::string>& words, const auto&) {
         called.push_back(words[0] + " " + words[1]);
         return R"({"n": )" + std::to_string(called.size()) + "}";
       }});
  EXPECT_THAT(called, ElementsAre("make data", "ask one", "ask two"));
  EXPECT_EQ(got.figures[0].as_printed, 2.0);
  EXPECT_EQ(got.figures[1].as_printed, 3.0);
  EXPECT_THAT(test::problems_of([&] { reproduce(read_paper_file(file), {.folder = folder.path()}); }),
              Contains(HasSubstr("need the program")));
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
  const auto problems = test::problems_of(
      [&] { reproduce(read_paper_file(place / "figures.yaml"), {.folder = folder.path()}); });
  EXPECT_THAT(problems, Contains(HasSubstr("clamping.yaml")));
  EXPECT_THAT(problems, Contains(HasSubstr("square.yaml")));
}

}  // namespace
}  // namespace flinch
