#include "experiments/reproduction/paper_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Of one figure, with `more` lines.
std::string file_with(const std::string& more) {
  return "figures:\n  - id: a.b.c\n    source: '[A] Table I'\n    title: time\n    paper: 10\n" + more;
}

const std::string printed = "    as_printed: {scenario: s.yaml, figure: 'contacts[0].detection_ms'}\n";

class FiguresFile : public testing::Test {
 protected:
  FiguresFile() { folder.write("s.yaml", "x: 1\n"); }
  std::vector<PaperFigure> read(const std::string& text) {
    return read_paper_figures(folder.write("figures.yaml", text));
  }
  std::vector<std::string> problems(const std::string& text) {
    return test::problems_of([&] { read(text); });
  }
  test::TemporaryFolder folder;
};

TEST_F(FiguresFile, SaysWhereEachFigureComesFrom) {
  const auto figures =
      read(file_with("    unit: ms\n    better: lower\n    within: 1.5\n    reason: open\n" + printed +
                     "    ours: {campaign: s.yaml, runs: 3, set: [{key: a.b, value: '[1, 2]'}], figure: most "
                     "groups.x, less: 'groups[0].y'}\n"));
  ASSERT_THAT(figures, SizeIs(1));
  const PaperFigure& figure = figures.front();
  EXPECT_EQ(figure.id, "a.b.c");
  EXPECT_EQ(figure.unit, "ms");
  EXPECT_EQ(figure.paper, 10.0);
  EXPECT_EQ(figure.within, 1.5);
  EXPECT_EQ(figure.better, PaperFigure::Better::lower);
  EXPECT_EQ(figure.reason, "open");
  ASSERT_TRUE(figure.as_printed && figure.ours);
  EXPECT_FALSE(figure.as_printed->is_campaign);
  EXPECT_EQ(figure.as_printed->file, folder / "s.yaml");
  EXPECT_TRUE(figure.ours->is_campaign);
  EXPECT_THAT(figure.ours->set, ElementsAre("a.b=[1, 2]"));
  EXPECT_EQ(figure.ours->runs, std::size_t{3});
  EXPECT_EQ(figure.ours->less, "groups[0].y");
}

TEST_F(FiguresFile, IsRefusedWithAllThatIsWrong) {
  EXPECT_THAT(problems(file_with("")), Contains(HasSubstr("has neither 'as_printed' nor 'ours'")));
  EXPECT_THAT(problems(file_with("    as_printed: {scenario: s.yaml, figure: 'contacts['}\n")),
              Contains(HasSubstr("it must be a path")));
  EXPECT_THAT(problems(file_with("    as_printed: {scenario: none.yaml, figure: a}\n")),
              Contains(HasSubstr("none.yaml")));
  EXPECT_THAT(problems(file_with(printed + "    within: 0.5\n")), Contains(HasSubstr("within")));
  EXPECT_THAT(problems(file_with(printed) + file_with(printed).substr(9)),
              Contains(HasSubstr("is 'a.b.c', as that of another figure")));
}

TEST(FiguresCalled, AreThoseWithTheWordOrSeveralInARow) {
  std::vector<PaperFigure> figures(3);
  figures[0].id = "safepr.table4.platform";
  figures[1].id = "safepr.table5.platform";
  figures[2].id = "ral25.table4.imu";
  EXPECT_THAT(figures_called(figures, "table4"), SizeIs(2));
  EXPECT_THAT(figures_called(figures, "safepr.table4"), SizeIs(1));
  EXPECT_THAT(figures_called(figures, "safepr"), SizeIs(2));
  EXPECT_THAT(test::problems_of([&] { figures_called(figures, "safepr.table4.platfrom"); }),
              ElementsAre(HasSubstr("did you mean 'safepr.table4.platform'?")));
}

TEST(ShippedFigures, CanBeReadAndNameTheirSources) {
  const auto figures = read_paper_figures(test::shipped("papers/papers.yaml"));
  std::set<std::string> papers;
  for (const PaperFigure& figure : figures) papers.insert(figure.source.substr(0, figure.source.find(' ')));
  EXPECT_THAT(papers, ElementsAre("[ICRA23]", "[RAL25]", "[SafePR]"));
}

}  // namespace
}  // namespace flinch
