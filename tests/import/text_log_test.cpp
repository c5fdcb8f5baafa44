#include "import/text_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "import/text_cells.h"
#include "import/text_lines.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::NanSensitiveDoubleEq;

class TextLogs : public testing::Test {
 protected:
  std::filesystem::path file_with(const std::string& text) const { return folder_.write("log.csv", text); }
  TextLog log_of(const std::string& text) const { return TextLog(file_with(text)); }

  static std::vector<std::string> names(const LogFile& log) {
    std::vector<std::string> all;
    for (const LogColumn& column : log.columns()) all.push_back(column.name);
    return all;
  }
  static std::vector<double> column(LogFile& log, const std::string& name) {
    const std::vector<std::size_t> wanted = {log.find(name)};
    return log.read(wanted, LogFile::all_rows).front();
  }

 private:
  test::TemporaryFolder folder_;
};

/// One table, as programs of many kinds write it.
TEST_F(TextLogs, HaveTheSameTableInWhateverWayItIsWritten) {
  const std::string utf16 = [] {
    std::string text = "\xFF\xFE";
    for (const char letter : std::string("t,q,i\r\n0,1.5,-2\r\n1,2.5,3\r\n"))
      text += std::string(1, letter) + std::string(1, '\0');
    return text;
  }();
  const std::vector<std::string> texts = {
      std::string("t,q,i\n0,1.5,-2\n1,2.5,3\n"),
      std::string("t;q;i\n0;1,5;-2\n1;2,5;3\n"),
      std::string("t\tq\ti\n0\t1,5\t-2\n1\t2,5\t3\n"),
      std::string("t|q|i\n0|1.5|-2\n1|2.5|3\n"),
      std::string("   t   q    i\n   0 1.5   -2\n   1 2.5    3\n"),
      std::string("\xEF\xBB\xBFt,q,i\r\n0,1.5,-2\r\n1,2.5,3\r\n"),
      std::string("t,q,i\r0,1.5,-2\r1,2.5,3\r"),
      std::string("# a robot\n# of 2026\nt,q,i\n0,1.5,-2\n1,2.5,3\n"),
      std::string("# t q i\n0 1.5 -2\n1 2.5 3\n"),
      std::string("Logger: x9\nRate;1000\n\nt;q;i\ns;deg;A\n0;1,5;-2\n1;2,5;3\n"),
      std::string("\"t\" , \"q\",i\n\"0\",\"+1.5\",-2\n1,25e-1,3\n"),
      std::string("\"0,5\",\"a\"\nt,q,i\n0,1.5,-2\n1,2.5,3\n"),
      std::string("t,q,i,\n0,1.5,-2,\n1,2.5,3,\n"),
      std::string(4096, '\0') + "t,q,i\n0,1.5,-2\n1,2.5,3\n" + std::string(4096, '\0'),
      utf16};
  for (const std::string& text : texts) {
    TextLog log = log_of(text);
    EXPECT_THAT(column(log, "t"), ElementsAre(0.0, 1.0)) << text;
    EXPECT_THAT(column(log, "q"), ElementsAre(1.5, 2.5)) << text;
    EXPECT_THAT(column(log, "i"), ElementsAre(-2.0, 3.0)) << text;
  }
}

TEST_F(TextLogs, NameTheirColumns) {
  EXPECT_THAT(names(log_of("t,\"phi, rad\",\"a \"\"b\"\"\"\n0,1,2\n1,2,3\n")),
              ElementsAre("t", "phi, rad", "a \"b\""));
  EXPECT_THAT(names(log_of("t,\"phi\n[rad]\"\n0,1\n1,2\n")), ElementsAre("t", "phi\n[rad]"));
  EXPECT_THAT(names(log_of("t,i,i\n0,1,2\n1,2,3\n")), ElementsAre("t", "i#1", "i#2"));
  EXPECT_THAT(names(log_of("0,1.5,2\n1,2.5,3\n2,2.6,4\n")), ElementsAre("1", "2", "3"));
  EXPECT_THAT(names(log_of(",0,1,2\n0,0.1,2.5,3\n1,0.2,2.6,4\n")), ElementsAre("column 1", "0", "1", "2"));
  EXPECT_THAT(
      names(log_of(",,robot:A,,robot:B,\nFrame,Sub,X,Y,X,Y\n,,mm,mm,mm,mm\n1,0,1.5,2,3,4\n2,0,1.6,2,3,4\n")),
      ElementsAre("Frame", "Sub", "robot:A.X", "robot:A.Y", "robot:B.X", "robot:B.Y"));
  EXPECT_THAT(names(log_of("t,q\n\"1\",0.1,2\n\"2\",0.2,3\n")), ElementsAre("row", "t", "q"));
  EXPECT_THAT(names(log_of("Time [sec]  phi [deg]\n  0.5        1\n  0.6        2\n")),
              ElementsAre("Time [sec]", "phi [deg]"));
}

TEST_F(TextLogs, TellUnitsOfTheirColumns) {
  const auto units = [&](const std::string& text) {
    std::vector<std::string> all;
    const TextLog log = log_of(text);
    for (const LogColumn& each : log.columns()) all.push_back(each.unit);
    return all;
  };
  EXPECT_THAT(units("t [ms],phi (deg),i_mA,x\n0,1,2,3\n1,2,3,4\n"), ElementsAre("ms", "deg", "mA", ""));
  EXPECT_THAT(units("t,phi\n[s],[rad]\n0,1\n1,2\n"), ElementsAre("[s]", "[rad]"));
  EXPECT_THAT(units("t,w_deg_per_s\n0,1\n1,2\n"), ElementsAre("", "deg_per_s"));
}

TEST_F(TextLogs, HaveNoNumberWhereTheirCellsHaveNone) {
  TextLog log = log_of("t,q\n0,\n1,nan\n2,NA\n3,-\n4,abc\n5,inf\n6,7\n");
  EXPECT_THAT(column(log, "q"), ElementsAre(NanSensitiveDoubleEq(NAN), NanSensitiveDoubleEq(NAN),
                                            NanSensitiveDoubleEq(NAN), NanSensitiveDoubleEq(NAN),
                                            NanSensitiveDoubleEq(NAN), NanSensitiveDoubleEq(NAN), 7.0));
  EXPECT_THAT(log.remarks(),
              ElementsAre(HasSubstr(
                  "column 'q': 1 cell are no number and so not valid, the first in line 6: 'abc'")));
}

TEST_F(TextLogs, SayWhichRowsAreNotAsTheOthers) {
  TextLog log = log_of("t,q,i\n0,1,2\n1,2\n2,3,4,5\nt,q,i\n3,4,5\n4,5");
  EXPECT_THAT(column(log, "t"), ElementsAre(0.0, 1.0, 3.0));
  EXPECT_THAT(log.remarks(), Contains(HasSubstr("line 7, the last one, is cut: it was left out")));
  EXPECT_THAT(log.remarks(), Contains(HasSubstr("1 row shorter than the others, first in line 3")));
  EXPECT_THAT(log.remarks(), Contains(HasSubstr("1 row with more cells than names")));
  EXPECT_THAT(log.remarks(), Contains(HasSubstr("the header comes again 1 time")));
}

TEST_F(TextLogs, TellInstantsExactly) {
  const auto instants = [&](const std::string& cell, ClockUnit unit) {
    return log_of("x,t\n1," + cell + "\n2,7\n").read_instants(1, unit, LogFile::all_rows).front();
  };
  EXPECT_EQ(instants("1766147454233218075", ClockUnit::ns), 1766147454233218075);
  EXPECT_EQ(instants("1766147454.233218075", ClockUnit::s), 1766147454233218075);
  EXPECT_EQ(instants("-0.001", ClockUnit::s), -1'000'000);
  EXPECT_EQ(instants("1.5e3", ClockUnit::us), 1'500'000);
  EXPECT_EQ(instants("0.0000000005", ClockUnit::s), 1);
  EXPECT_EQ(instants("", ClockUnit::s), no_instant);
}

TEST_F(TextLogs, TellDatesAndTimes) {
  const auto instant = [&](const std::string& cell) {
    return log_of("t;x\n" + cell + ";1\n" + cell + ";2\n")
        .read_instants(0, ClockUnit::s, LogFile::all_rows)
        .front();
  };
  constexpr std::int64_t day = 20'484LL * 86'400 * 1'000'000'000;  // 2026-01-31
  constexpr std::int64_t time = 43'201'250'000'000;
  for (const char* const cell :
       {"2026-01-31T12:00:01.25Z", "2026-01-31 12:00:01,250", "2026-01-31T13:00:01.25+01:00",
        "31.01.2026 12:00:01.25", "01/31/2026 12:00:01.25 PM", "31/01/2026 12:00:01.25",
        "2026/01/31 12:00:01.250000000"})
    EXPECT_EQ(instant(cell), day + time) << cell;
  EXPECT_EQ(instant("2026-01-31"), day);
  EXPECT_EQ(instant("12:00:01.25"), time);
}

TEST_F(TextLogs, KeepNothingOfColumnsThatNobodyWants) {
  std::string header = "t";
  for (int i = 0; i < 50'000; ++i) header += ",x";
  std::string row = "1" + std::string(50'000, ',') + "\n", rows;
  for (int k = 0; k < 100; ++k) rows += row;  // all cells of this table would take 40 MB
  TextLog log = log_of(header + "\n" + rows);
  EXPECT_EQ(column(log, "t").size(), 100U);
}

TEST_F(TextLogs, RefuseWhatTheyCannotRead) {
  const auto problems = [&](const std::string& text) {
    return test::problems_of([&] { open_log(file_with(text)); });
  };
  EXPECT_THAT(problems("a poem\nof two lines\n"), ElementsAre(HasSubstr("log.csv: has no table")));
  EXPECT_THAT(problems(std::string("t\0,q\n1,2\n", 9)), ElementsAre(HasSubstr("log.csv: is no text")));
  EXPECT_THAT(
      problems("a,b,c,d,e\n1.5,2,3,4,5,6\n2.5,3,4,5,6,7\n2.5,3,4,5,6,7\n"),
      ElementsAre(HasSubstr("log.csv:1: the header has 5 names, and the rows below it have 6 cells")));
  EXPECT_THAT(test::problems_of([] { open_log("nowhere.csv"); }),
              ElementsAre("nowhere.csv: there is no such file"));
  EXPECT_THAT(test::problems_of([] { open_log("/dev/zero"); }), ElementsAre(HasSubstr("is no regular file")));
  TextLog log = log_of("time,current_1,i,i\n0,1,2,3\n1,2,3,4\n");
  EXPECT_THAT(test::problems_of([&] { log.find("curent_1"); }),
              ElementsAre(EndsWith("there is no column 'curent_1'; did you mean 'current_1'?")));
  EXPECT_THAT(test::problems_of([&] { log.find("i"); }), ElementsAre(HasSubstr("name 'i#1', 'i#2'")));
  EXPECT_EQ(log.find("2"), 1U);
}

}  // namespace
}  // namespace flinch
