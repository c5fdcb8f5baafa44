#include "experiments/reproduction/paper_file.h"

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
  PaperFigures read(const std::string& text) { return read_paper_file(folder.write("figures.yaml", text)); }
  std::vector<std::string> problems(const std::string& text) {
    return test::problems_of([&] { read(text); });
  }
  test::TemporaryFolder folder;
};

TEST_F(FiguresFile, SaysWhereEachFigureComesFrom) {
  const std::vector<PaperFigure> figures =
      read(file_with("    unit: ms\n    better: lower\n    within: 1.5\n    reason: open\n" + printed +
                     "    ours: {campaign: s.yaml, runs: 3, set: [{key: a.b, value: '[1, 2]'}], figure: most "
                     "groups.x, less: 'groups[0].y', per: n, times: 100}\n"))
          .figures;
  ASSERT_THAT(figures, SizeIs(1));
  const PaperFigure& figure = figures.front();
  EXPECT_EQ(figure.id, "a.b.c");
  EXPECT_EQ(figure.unit, "ms");
  EXPECT_EQ(figure.paper, 10.0);
  EXPECT_EQ(figure.within, 1.5);
  EXPECT_EQ(figure.better, PaperFigure::Better::lower);
  EXPECT_EQ(figure.reason, "open");
  ASSERT_TRUE(figure.as_printed && figure.ours);
  EXPECT_EQ(figure.as_printed->run.kind, RunSource::Kind::scenario);
  EXPECT_EQ(figure.as_printed->run.file, folder / "s.yaml");
  EXPECT_EQ(figure.ours->run.kind, RunSource::Kind::campaign);
  EXPECT_THAT(figure.ours->run.set, ElementsAre("a.b=[1, 2]"));
  EXPECT_EQ(figure.ours->run.runs, std::size_t{3});
  EXPECT_EQ(figure.ours->per, "n");
  EXPECT_EQ(figure.ours->times, 100.0);
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

TEST_F(FiguresFile, NamesCurvesOfARecordingAndCommands) {
  const PaperFigures all = read(file_with(
      "    as_printed: {scenario: s.yaml, take: share_of_range, times: 100,\n"
      "      curve: {length_of: 'a.b[0] - c.d[0], a.b[1] - c.d[1]', from_ms: 300, since_contact: true},\n"
      "      other: {of: c.d}}\n"
      "    ours: {commands: \"dataset s.yaml --set 'a={b: [1, 2]}' && evaluate m d.h5 --json\", figure: "
      "body}\n"));
  ASSERT_THAT(all.figures, SizeIs(1));
  const FigureSource& printed_source = *all.figures.front().as_printed;
  ASSERT_TRUE(printed_source.curve);
  EXPECT_TRUE(printed_source.curve->is_length);
  ASSERT_THAT(printed_source.curve->terms, SizeIs(2));
  EXPECT_EQ(printed_source.curve->terms[1].of, (SignalNumber{"a", "b", 1}));
  EXPECT_EQ(*printed_source.curve->terms[1].less, (SignalNumber{"c", "d", 1}));
  EXPECT_EQ(*printed_source.curve->from, 0.3);
  EXPECT_TRUE(printed_source.curve->since_contact);
  EXPECT_EQ(printed_source.statistic.kind, CurveStatistic::Kind::share_of_range);
  EXPECT_TRUE(printed_source.statistic.other);
  const RunSource& commands = all.figures.front().ours->run;
  EXPECT_THAT(commands.commands,
              ElementsAre(ElementsAre("dataset", (folder / "s.yaml").string(), "--set", "a={b: [1, 2]}"),
                          ElementsAre("evaluate", "m", "d.h5", "--json")));
}

TEST_F(FiguresFile, NamesPictures) {
  const PaperFigures all = read(
      "pictures:\n  - id: a.b\n    source: '[A] Fig. 1'\n    title: force\n    x: time, ms\n    y: force, N\n"
      "    lines: [{name: one, scenario: s.yaml, curve: {of: a.b}, over: {of: c.d, times: 1000}}]\n"
      "    dots: [{name: two, campaign: s.yaml, x: x_m, x_less: y_m, y: z_N, x_times: 1000, body: link1, "
      "with_line: true}]\n"
      "    marks: [{name: limit, y: 140}, {x: 3}]\n"
      "  - {id: a.c, source: '[A] Fig. 2', title: told, matrix: {commands: ask --json, key: confusion}}\n");
  ASSERT_THAT(all.pictures, SizeIs(2));
  ASSERT_TRUE(all.pictures[1].matrix);
  EXPECT_EQ(all.pictures[1].matrix->key, "confusion");
  const PaperPicture& picture = all.pictures.front();
  ASSERT_TRUE(picture.lines.size() == 1 && picture.dots.size() == 1 && picture.marks.size() == 2);
  EXPECT_EQ(picture.lines[0].over->times, 1000.0);
  EXPECT_EQ(picture.dots[0].x_less, "y_m");
  EXPECT_EQ(picture.dots[0].of, "link1");
  EXPECT_TRUE(picture.dots[0].with_line);
  EXPECT_EQ(picture.marks[0].at, 140.0);
  EXPECT_FALSE(picture.marks[0].upright);
  EXPECT_TRUE(picture.marks[1].upright);
}

TEST_F(FiguresFile, WithCurvesThatNameNoNumberIsRefused) {
  const auto curve = [&](const std::string& text) {
    return problems(file_with("    as_printed: {scenario: s.yaml, curve: {" + text + "}}\n"));
  };
  EXPECT_THAT(curve("of: motion"), Contains(HasSubstr("is no recorded number")));
  EXPECT_THAT(curve("of: 'a.b[x]'"), Contains(HasSubstr("is no recorded number")));
  EXPECT_THAT(curve("of: 'a.b, a.c'"), Contains(HasSubstr("write 'length_of'")));
  EXPECT_THAT(curve("of: a.b, where: valid"), Contains(HasSubstr("where")));
  EXPECT_THAT(problems("pictures: [{id: a, source: '[A]', title: t, x: x, y: y}]\n"),
              Contains(HasSubstr("has neither 'lines' nor 'dots'")));
  EXPECT_THAT(problems("figures: []\n"), Contains(HasSubstr("figures")));
}

/// "[SafePR] Fig. 9": of figures and pictures.
std::set<std::string> sources_of(const PaperFigures& all) {
  std::set<std::string> sources;
  for (const PaperFigure& figure : all.figures) sources.insert(figure.source);
  for (const PaperPicture& picture : all.pictures) sources.insert(picture.source);
  return sources;
}

TEST(ShippedFigures, HaveAllThatThePapersMeasure) {
  const std::set<std::string> sources = sources_of(read_paper_file(test::shipped("papers/papers.yaml")));
  for (const int number : {9, 10, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24})
    EXPECT_TRUE(sources.contains("[SafePR] Fig. " + std::to_string(number))) << number;
  for (const int number : {4, 5, 6}) EXPECT_TRUE(sources.contains("[ICRA23] Fig. " + std::to_string(number)));
  for (const int number : {4, 5, 7, 8, 10})
    EXPECT_TRUE(sources.contains("[RAL25] Fig. " + std::to_string(number)));
  for (const char* const table :
       {"[SafePR] Table IV", "[SafePR] Table V", "[RAL25] Table II", "[RAL25] Table III"})
    EXPECT_TRUE(sources.contains(table)) << table;
}

}  // namespace
}  // namespace flinch
