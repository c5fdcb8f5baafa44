#include "calibration/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class Csv : public testing::Test {
 protected:
  std::filesystem::path file_with(const std::string& text) const { return folder_.write("table.csv", text); }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Csv, HasTheColumnsThatAreWanted) {
  const CsvTable table =
      read_csv(file_with("t, \"q1\" ,name\r\n0,+1.5,a\r\n1,-2e-3,b\r\n\n"), ',', {"t", "q1"});
  ASSERT_EQ(table.values.rows(), 2);
  EXPECT_EQ(table.values(0, table.find("q1")), 1.5);
  EXPECT_EQ(table.values(1, table.find("q1")), -2e-3);
  EXPECT_EQ(table.find("q2"), -1);
}

TEST_F(Csv, KeepsNothingOfColumnsThatNobodyWants) {
  std::string names = "t";
  for (int i = 0; i < 50'000; ++i) names += ",x";
  std::string rows;
  for (int k = 0; k < 50'000; ++k) rows += "1\n";  // all cells of this table would take 20 GB
  const CsvTable table = read_csv(file_with(names + "\n" + rows), ',', {"t"});
  EXPECT_EQ(table.values.rows(), 50'000);
  EXPECT_EQ(table.values.cols(), 1);
}

TEST_F(Csv, TellsRowAndColumnOfWhatIsNoNumber) {
  const auto file = file_with("t;q1\n0;1\n1;abc\n2\n3;nan\n");
  EXPECT_THAT(test::problems_of([&] {
                read_csv(file, ';', {"t", "q1"});
              }),
              ElementsAre(EndsWith(".csv:3: column 'q1' is 'abc'; it must be a number"),
                          EndsWith(".csv:4: column 'q1' is missing; the row has 1 cells"),
                          EndsWith(".csv:5: column 'q1' is 'nan'; it must be a number")));
}

TEST_F(Csv, TellsAColumnThatIsNotThere) {
  const auto file = file_with("time,current_1\n0,1\n");
  EXPECT_THAT(test::problems_of([&] { read_csv(file, ',', {"curent_1"}); }),
              ElementsAre(HasSubstr(".csv:1: there is no column 'curent_1'; did you mean 'current_1'?")));
}

TEST_F(Csv, IsText) {
  EXPECT_THAT(test::problems_of([this] { read_csv(file_with("\x89HDF\r\n"), ',', {"t"}); }),
              ElementsAre(EndsWith("table.csv: is an HDF5 file; name it as 'hdf5'")));
  EXPECT_THAT(test::problems_of([this] { read_csv(file_with(std::string("t\0,q\n1,2\n", 9)), ',', {"t"}); }),
              ElementsAre(HasSubstr("table.csv: is no text; it must be CSV")));
}

TEST_F(Csv, ThatIsNotThereIsTold) {
  EXPECT_THAT(test::problems_of([] { read_csv("nowhere.csv", ',', {}); }),
              ElementsAre("nowhere.csv: there is no such file"));
  EXPECT_THAT(test::problems_of([] { read_csv("/dev/zero", ',', {}); }),
              ElementsAre("/dev/zero: is no regular file; it must be one"));
}

}  // namespace
}  // namespace flinch
