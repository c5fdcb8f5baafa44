#include "calibration/hdf5_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/hdf5_object.h"
#include "tests/support/hdf5_columns.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using internal::Hdf5Object;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Hdf5Table : public testing::Test {
 protected:
  std::filesystem::path written(const std::function<void(Hdf5Object::Id)>& fill) const {
    internal::write_hdf5_result(folder_ / "table.h5", 1U << 20U, fill);
    return folder_ / "table.h5";
  }

 private:
  test::TemporaryFolder folder_;
};

std::vector<std::string> problems(const std::filesystem::path& file, const std::vector<std::string>& wanted) {
  return test::problems_of([&] { read_hdf5_table(file, wanted); });
}

TEST_F(Hdf5Table, ReadsDataSetsOfOneDimensionAndOfTwoOfAnyNumbers) {
  const auto file = written([](Hdf5Object::Id id) {
    test::write_reals(id, "t", {0.0, 0.5, 1.0});
    const Hdf5Object counts = internal::make_table(id, "counts", Field::Kind::integer, 2, 10);
    std::vector<internal::Number> numbers(6);
    for (int i = 0; i < 6; ++i) numbers[static_cast<std::size_t>(i)].integer = 10 * i;
    internal::append_rows(counts, Field::Kind::integer, 0, 3, 2, numbers.data());
  });
  const CsvTable table = read_hdf5_table(file, {"t", "/counts[1]"});
  EXPECT_EQ(table.first_row, 1);
  EXPECT_EQ(table.values, (Eigen::Matrix<double, 3, 2>() << 0.0, 10.0, 0.5, 30.0, 1.0, 50.0).finished());
}

// A chunk of this recording claims 2 GB in a file of 20 kB.
TEST_F(Hdf5Table, BelievesTheStoredSizeOfAChunkAsFarAsTheFileIsLong) {
  const std::filesystem::path file = FLINCH_SOURCE_DIR "/tests/fuzz/corpus/recording/stored_size_of_a_chunk";
  EXPECT_THAT(problems(file, {"time_ns"}), Contains(HasSubstr("more than the file")));
}

TEST_F(Hdf5Table, NamesRowAndColumnOfWhatIsWrong) {
  const auto file = written([](Hdf5Object::Id id) {
    test::write_reals(id, "t", {0.0, 0.5, 1.0});
    test::write_reals(id, "q", {0.0, std::nan(""), 1.0});
    test::write_reals(id, "short", {0.0});
    test::write_texts(id, "words", {"a", "b", "c"});
  });
  EXPECT_THAT(problems(file, {"t", "q"}),
              ElementsAre(HasSubstr("table.h5:2: column 'q' is no finite number")));
  EXPECT_THAT(problems(file, {"t", "short"}), ElementsAre(HasSubstr("has 1 rows, and 't' has 3")));
  EXPECT_THAT(problems(file, {"t", "q[1]"}), ElementsAre(HasSubstr("the data set has 1 columns")));
  EXPECT_THAT(problems(file, {"t", "words"}), ElementsAre(HasSubstr("has no numbers")));
  EXPECT_THAT(problems(file, {"t", "gone"}), ElementsAre(HasSubstr("column 'gone': HDF5 failed opening")));
  EXPECT_THAT(problems(file, {"t", "q[x]"}), ElementsAre(HasSubstr("must end in a number in brackets")));
  EXPECT_THAT(problems("nowhere.h5", {"t"}), Contains(HasSubstr("nowhere.h5")));
}

}  // namespace
}  // namespace flinch
