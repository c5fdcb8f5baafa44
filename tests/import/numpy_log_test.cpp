#include "import/numpy_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/numpy_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using test::npy;
using test::zip;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsNan;

class NumpyLogs : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

 private:
  test::TemporaryFolder folder_;
};

std::vector<double> column(LogFile& log, const std::string& name) {
  const std::vector<std::size_t> wanted = {log.find(name)};
  return log.read(wanted).front();
}

const std::vector<double> six = {0.0, 1.0, 2.0, 10.0, 11.0, std::nan("")};

TEST_F(NumpyLogs, HaveAColumnForEachNumberOfARow) {
  const auto log = open_log(file("run.npz", zip({{"t.npy", npy<double>("<f8", "(3,)", {0.0, 0.5, 1.0})},
                                                 {"q.npy", npy("<f8", "(3, 2)", six)},
                                                 {"note.txt", "no array"}})));
  EXPECT_THAT(column(*log, "t"), ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(column(*log, "q[0]"), ElementsAre(0.0, 2.0, 11.0));
  EXPECT_THAT(column(*log, "q[1]"), ElementsAre(1.0, 10.0, IsNan()));
  EXPECT_EQ(log->columns()[0].table, log->columns()[1].table);
}

TEST_F(NumpyLogs, TakeTheLongDimensionForRowsInEitherOrder) {
  EXPECT_THAT(column(*open_log(file("wide.npy", npy("<f8", "(2, 3)", six))), "wide[1]"),
              ElementsAre(10.0, 11.0, IsNan()));
  EXPECT_THAT(column(*open_log(file("f.npy", npy("<f8", "(3, 2)", six, true))), "f[1]"),
              ElementsAre(10.0, 11.0, IsNan()));
  EXPECT_THAT(column(*open_log(file("fw.npy", npy("<f8", "(2, 3)", six, true))), "fw[0]"),
              ElementsAre(0.0, 2.0, 11.0));
}

TEST_F(NumpyLogs, MayHaveNumbersOfAnyType) {
  EXPECT_THAT(column(*open_log(file("a.npy", npy<float>("<f4", "(2,)", {1.5F, -2.0F}))), "a"),
              ElementsAre(1.5, -2.0));
  EXPECT_THAT(column(*open_log(file("a.npy", npy<std::int16_t>("<i2", "(2,)", {-3, 7}))), "a"),
              ElementsAre(-3.0, 7.0));
  EXPECT_THAT(column(*open_log(file("a.npy", npy<std::uint8_t>("|b1", "(2,)", {1, 0}))), "a"),
              ElementsAre(1.0, 0.0));
  EXPECT_THAT(column(*open_log(file("a.npy", npy<std::uint8_t>(">u2", "(1,)", {1, 2}))), "a"),
              ElementsAre(258.0));
}

TEST_F(NumpyLogs, KeepInstantsExact) {
  const std::int64_t begin = 1'700'000'000'123'456'789;
  const auto of_time = open_log(file("t.npy", npy<std::int64_t>("<M8[ns]", "(2,)", {begin, begin + 1})));
  EXPECT_THAT(of_time->read_instants(0, ClockUnit::s), ElementsAre(begin, begin + 1));
  const auto of_seconds = open_log(file("t.npy", npy<double>("<f8", "(3,)", {0.0, 0.5, std::nan("")})));
  EXPECT_THAT(of_seconds->read_instants(0, ClockUnit::s), ElementsAre(0, 500'000'000, no_instant));
  const auto of_counts = open_log(file("t.npy", npy<std::int64_t>("<i8", "(2,)", {begin, begin + 1})));
  EXPECT_THAT(of_counts->read_instants(0, ClockUnit::ns), ElementsAre(begin, begin + 1));
}

TEST_F(NumpyLogs, ThatAreBrokenAreRefusedWithTheReason) {
  const auto problems = [&](const std::string& name, const std::string& bytes) {
    const auto path = file(name, bytes);
    return test::problems_of([&] {
      const auto log = open_log(path);
      log->read(std::vector<std::size_t>{0});
    });
  };
  const std::string good = zip({{"t.npy", npy<double>("<f8", "(3,)", {0.0, 0.5, 1.0})}});
  EXPECT_THAT(problems("cut.npz", good.substr(0, good.size() - 30)),
              Contains(HasSubstr("the archive is cut")));
  std::string changed = good;
  changed[good.find("t.npy") + 5 + 128 + 3] ^= 1;
  EXPECT_THAT(problems("changed.npz", changed), Contains(HasSubstr("its checksum is another")));
  EXPECT_THAT(problems("cut.npy", npy<double>("<f8", "(4,)", {1.0, 2.0})), Contains(HasSubstr("it is cut")));
  EXPECT_THAT(problems("text.npy", npy<double>("<U2", "(2,)", {1.0})),
              Contains(HasSubstr("which is no number")));
  EXPECT_THAT(problems("cube.npy", npy<double>("<f8", "(1, 1, 1)", {1.0})),
              Contains(HasSubstr("has 3 dimensions")));
}

}  // namespace
}  // namespace flinch
