#include "import/matlab_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/matlab_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using test::mat_deflated;
using test::mat_double;
using test::mat_file;
using test::mat_matrix;
using test::mat_structs;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsNan;

class MatlabLogs : public testing::Test {
 protected:
  std::filesystem::path file(const std::vector<std::string>& variables) const {
    return raw(mat_file(variables));
  }
  std::filesystem::path raw(const std::string& bytes) const {
    std::ofstream(folder_ / "some.mat", std::ios::binary) << bytes;
    return folder_ / "some.mat";
  }
  std::vector<std::string> problems(const std::string& bytes) const {
    const auto path = raw(bytes);
    return test::problems_of([&] {
      const auto log = open_log(path);
      log->read(std::vector<std::size_t>{0});
    });
  }

 private:
  test::TemporaryFolder folder_;
};

std::vector<double> values_of(LogFile& log, const std::string& name) {
  const std::vector<std::size_t> wanted = {log.find(name)};
  return log.read(wanted).front();
}

const std::string three_times = mat_matrix<double>(mat_double, "t", 3, 1, {0.0, 0.5, 1.0});
const std::string two_angles = mat_matrix<double>(mat_double, "q", 3, 2, {0.0, 1.0, 2.0, 10.0, 11.0, NAN});

TEST_F(MatlabLogs, HaveAColumnForEachNumberOfARowDeflatedOrNot) {
  for (const std::vector<std::string>& variables :
       {std::vector{three_times, two_angles},
        std::vector{mat_deflated(three_times), mat_deflated(two_angles)}}) {
    const auto log = open_log(file(variables));
    EXPECT_THAT(values_of(*log, "t"), ElementsAre(0.0, 0.5, 1.0));
    EXPECT_THAT(values_of(*log, "q[0]"), ElementsAre(0.0, 1.0, 2.0));
    EXPECT_THAT(values_of(*log, "q[1]"), ElementsAre(10.0, 11.0, IsNan()));
    EXPECT_EQ(log->columns()[0].table, log->columns()[1].table);
    const std::vector<std::size_t> two = {log->find("q[1]"), log->find("t")};
    EXPECT_THAT(log->read(two, 2), ElementsAre(ElementsAre(10.0, 11.0), ElementsAre(0.0, 0.5)));
  }
}

TEST_F(MatlabLogs, TakeTheLongDimensionForRows) {
  const auto wide = mat_matrix<double>(mat_double, "wide", 2, 3, {0.0, 10.0, 1.0, 11.0, 2.0, 12.0});
  EXPECT_THAT(values_of(*open_log(file({wide})), "wide[1]"), ElementsAre(10.0, 11.0, 12.0));
  const auto row = mat_matrix<double>(mat_double, "row", 1, 3, {5.0, 6.0, 7.0});
  EXPECT_THAT(values_of(*open_log(file({row})), "row"), ElementsAre(5.0, 6.0, 7.0));
}

TEST_F(MatlabLogs, MayHaveNumbersOfAnyClass) {
  const auto log = open_log(file({mat_matrix<float>(test::mat_single, "f", 2, 1, {1.5F, -2.0F}),
                                  mat_matrix<std::uint8_t>(test::mat_uint8, "u", 2, 1, {7, 255})}));
  EXPECT_THAT(values_of(*log, "f"), ElementsAre(1.5, -2.0));
  EXPECT_THAT(values_of(*log, "u"), ElementsAre(7.0, 255.0));
}

TEST_F(MatlabLogs, KeepInstantsExact) {
  const std::int64_t begin = 1'700'000'000'123'456'789;
  const auto log = open_log(file({mat_matrix<std::int64_t>(test::mat_int64, "ns", 2, 1, {begin, begin + 1}),
                                  mat_matrix<double>(mat_double, "s", 2, 1, {0.5, std::nan("")})}));
  EXPECT_THAT(log->read_instants(log->find("ns"), ClockUnit::ns), ElementsAre(begin, begin + 1));
  EXPECT_THAT(log->read_instants(log->find("s"), ClockUnit::s), ElementsAre(500'000'000, no_instant));
}

TEST_F(MatlabLogs, NameFieldsOfStructsInStructs) {
  const auto time = mat_matrix<double>(mat_double, "", 2, 1, {0.0, 0.1});
  const auto angle = mat_matrix<double>(mat_double, "", 2, 1, {3.0, 4.0});
  const auto inner = mat_structs("", {"q"}, {angle});
  const auto one = open_log(file({mat_structs("run", {"time", "legs"}, {time, inner})}));
  EXPECT_THAT(values_of(*one, "run.legs.q"), ElementsAre(3.0, 4.0));
  const auto several =
      open_log(file({mat_deflated(mat_structs("run", {"t", "q"}, {time, angle, time, time}))}));
  EXPECT_THAT(values_of(*several, "run[0].q"), ElementsAre(3.0, 4.0));
  EXPECT_THAT(values_of(*several, "run[1].q"), ElementsAre(0.0, 0.1));
}

TEST_F(MatlabLogs, SayWhatTheyLeaveOut) {
  const auto log = open_log(file({test::mat_text("note", "tuesday"), three_times}));
  EXPECT_THAT(log->remarks(), ElementsAre("'note' is a text; left out"));
  EXPECT_THAT(problems(mat_file({test::mat_text("note", "tuesday")})),
              ElementsAre(HasSubstr("some.mat: holds no matrix of numbers that can be read"),
                          HasSubstr("'note' is a text")));
}

TEST_F(MatlabLogs, ThatAreCutOrDamagedAreRefusedAndNeverReadAsZero) {
  for (const std::string& second : {two_angles, mat_deflated(two_angles)}) {
    const std::string good = mat_file({three_times, second});
    for (std::size_t left = 128 + three_times.size() + 1; left < good.size(); left += 7)
      EXPECT_THAT(problems(good.substr(0, left)),
                  ElementsAre(HasSubstr("the file is cut in its variable number 2; save it again")))
          << left;
  }
  std::string damaged = mat_file({mat_deflated(two_angles)});
  damaged[damaged.size() - 2] ^= 1;  // in the sum
  EXPECT_THAT(problems(damaged), ElementsAre(HasSubstr("the file is damaged in its variable number 1")));
  const auto claims = mat_matrix<double>(mat_double, "q", 1'000'000'000, 3, {1.0, 2.0});
  EXPECT_THAT(problems(mat_file({claims})),
              ElementsAre(HasSubstr("the file is damaged in its variable number 1")));
}

TEST_F(MatlabLogs, EndInNoOtherWayWhateverIsWrittenOverThem) {
  const auto time = mat_matrix<double>(mat_double, "", 2, 1, {0.0, 0.1});
  const std::string good =
      mat_file({three_times, mat_structs("run", {"t", "q"}, {time, time}), test::mat_text("a", "b")});
  for (std::size_t at = 128; at < good.size(); ++at) {
    for (const char byte : {'\0', '\1', '\x7f', '\xff'}) {
      std::string bytes = good;
      bytes[at] = byte;
      EXPECT_NO_THROW(problems(bytes));  // a SetupError is caught there
    }
  }
}

}  // namespace
}  // namespace flinch
