#include "import/hdf5_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/hdf5_table.h"
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

std::vector<double> column(LogFile& log, const std::string& name) {
  const std::vector<std::size_t> wanted = {log.find(name)};
  return log.read(wanted, LogFile::all_rows).front();
}

TEST_F(Hdf5Table, ReadsDataSetsOfOneDimensionAndOfTwoOfAnyNumbers) {
  Hdf5Log log(written([](Hdf5Object::Id id) {
    test::write_reals(id, "t", {0.0, 0.5, 1.0});
    const Hdf5Object counts = internal::make_table(id, "counts", Field::Kind::integer, 2, 10);
    std::vector<internal::Number> numbers(6);
    for (int i = 0; i < 6; ++i) numbers[static_cast<std::size_t>(i)].integer = 10 * i;
    internal::append_rows(counts, Field::Kind::integer, 0, 3, 2, numbers.data());
  }));
  EXPECT_THAT(column(log, "t"), ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(column(log, "/counts[1]"), ElementsAre(10.0, 30.0, 50.0));
  EXPECT_THAT(log.read_instants(log.find("t"), ClockUnit::s, LogFile::all_rows),
              ElementsAre(0, 500'000'000, 1'000'000'000));
}

TEST_F(Hdf5Table, TakesTheLongDimensionForRows) {
  Hdf5Log log(written([](Hdf5Object::Id id) {
    const Hdf5Object row = internal::make_table(id, "row", Field::Kind::real, 4, 10);
    std::vector<internal::Number> numbers(8);
    for (int i = 0; i < 8; ++i) numbers[static_cast<std::size_t>(i)].real = i;
    internal::append_rows(row, Field::Kind::real, 0, 1, 4, numbers.data());
    const Hdf5Object wide = internal::make_table(id, "wide", Field::Kind::real, 4, 10);
    internal::append_rows(wide, Field::Kind::real, 0, 2, 4, numbers.data());
  }));
  EXPECT_THAT(column(log, "row"), ElementsAre(0.0, 1.0, 2.0, 3.0));
  EXPECT_THAT(column(log, "wide[1]"), ElementsAre(4.0, 5.0, 6.0, 7.0));
}

TEST_F(Hdf5Table, HasATableForEachGroup) {
  Hdf5Log log(written([](Hdf5Object::Id id) {
    const Hdf5Object fast = internal::make_group(id, "fast"), slow = internal::make_group(id, "slow");
    test::write_reals(fast, "t", {0.0, 1.0, 2.0});
    test::write_reals(slow, "t", {0.0, 2.0});
    test::write_texts(slow, "words", {"a", "b"});
  }));
  EXPECT_NE(log.columns()[log.find("/fast/t")].table, log.columns()[log.find("/slow/t")].table);
  EXPECT_THAT(log.remarks(), ElementsAre(HasSubstr("'/slow/words' has no numbers")));
}

// A chunk of this recording claims 2 GB in a file of 20 kB.
TEST_F(Hdf5Table, BelievesTheStoredSizeOfAChunkAsFarAsTheFileIsLong) {
  Hdf5Log log(FLINCH_SOURCE_DIR "/tests/fuzz/corpus/recording/stored_size_of_a_chunk");
  EXPECT_THAT(test::problems_of([&] { column(log, "time_ns"); }), Contains(HasSubstr("more than the file")));
}

TEST_F(Hdf5Table, NamesWhatIsNotThere) {
  const auto file = written([](Hdf5Object::Id id) { test::write_reals(id, "time", {0.0, 0.5, 1.0}); });
  const Hdf5Log log(file);
  EXPECT_THAT(test::problems_of([&] { log.find("tme"); }),
              ElementsAre(HasSubstr("table.h5: there is no column 'tme'; did you mean '/time'")));
  EXPECT_THAT(test::problems_of([] { Hdf5Log("nowhere.h5"); }), Contains(HasSubstr("nowhere.h5")));
  const auto words = written([](Hdf5Object::Id id) { test::write_texts(id, "words", {"a", "b"}); });
  EXPECT_THAT(test::problems_of([&] { Hdf5Log{words}; }),
              Contains(HasSubstr("holds no data set of numbers")));
}

}  // namespace
}  // namespace flinch
