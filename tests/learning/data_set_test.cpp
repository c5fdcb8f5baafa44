#include "learning/data_set.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "systems/config/robot_file.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/hdf5_object.h"
#include "systems/framework/random.h"
#include "tests/learning/contact_examples.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

class DataSetFile : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_ / "data.h5"; }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(DataSetFile, ComesBackBitForBitFromItsFile) {
  const DataSet data = test::contact_examples(300, 1);
  const auto file = this->file();
  write_data_set(data, file);
  const DataSet read = read_data_set(file);
  EXPECT_EQ(read.card, data.card);
  EXPECT_EQ(read.robot_text, data.robot_text);
  EXPECT_EQ(read.robot_file, data.robot_file);
  EXPECT_EQ(read.sha256, sha256(test::bytes_of(file)));
  ASSERT_EQ(read.samples.size(), data.samples.size());
  for (std::size_t i = 0; i < data.samples.size(); ++i) {
    const DataSample &a = read.samples[i], &b = data.samples[i];
    EXPECT_EQ(std::tie(a.run, a.configuration, a.moment, a.touched, a.since_onset, a.since_early, a.force),
              std::tie(b.run, b.configuration, b.moment, b.touched, b.since_onset, b.since_early, b.force));
    EXPECT_EQ(a.pose, b.pose);
    for (std::size_t k = 0; k < a.course.size(); ++k) {
      EXPECT_EQ(a.course[k].velocity, b.course[k].velocity);
      EXPECT_EQ(a.course[k].wrench_in_base, b.course[k].wrench_in_base);
    }
  }
  const std::string bytes = test::bytes_of(file);
  write_data_set(read, file);
  EXPECT_EQ(test::bytes_of(file), bytes);
}

TEST_F(DataSetFile, SaysWhatIsWrongWithAFile) {
  const auto file = this->file();
  EXPECT_THAT(test::problems_of([&] { read_data_set(file); }),
              testing::ElementsAre(file.string() + ": there is no such file"));
  write_data_set(test::contact_examples(50, 1), file);
  const std::string bytes = test::bytes_of(file);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes.substr(0, bytes.size() / 2);
  const auto problems = test::problems_of([&] { read_data_set(file); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems.front(), testing::StartsWith(file.string() + ": "));

  DataSet data = test::contact_examples(50, 1);
  data.samples[7].pose[0] = std::nan("");
  write_data_set(data, file);
  EXPECT_THAT(test::problems_of([&] { read_data_set(file); }),
              testing::ElementsAre(file.string() + ": sample 7 has a number that is not finite"));
  data = test::contact_examples(50, 1);
  data.samples[9].touched = 10;
  write_data_set(data, file);
  EXPECT_THAT(
      test::problems_of([&] { read_data_set(file); }),
      testing::ElementsAre(file.string() + ": sample 9 has 10 where a whole number from 0 to 9 belongs"));
}

TEST_F(DataSetFile, OfAnotherVersionMustBeMadeAnew) {
  internal::write_hdf5_result(file(), 1000, [](internal::Hdf5Object::Id id) {
    internal::write_text(id, "format", "flinch contacts 1");
  });
  EXPECT_THAT(test::problems_of([&] { read_data_set(file()); }),
              testing::ElementsAre(file().string() + ": is a data set of another version ('flinch contacts "
                                                     "1'); make it anew with 'flinch dataset'"));
}

TEST_F(DataSetFile, SurvivesBytesThatChange) {
  const auto file = this->file();
  write_data_set(test::contact_examples(20, 1), file);
  const std::string whole = test::bytes_of(file);
  RandomGenerator random(3);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = whole;
    for (std::uint64_t i = 0; i <= random() % 8; ++i)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    if (!test::problems_of([&] { read_data_set(file); }).empty()) ++refused;
  }
  EXPECT_GT(refused, 10);
}

TEST(DataSet, KnowsARobotByItsParametersAndNotByComments) {
  const DataSet data = test::contact_examples(1, 1);
  const std::string same = fingerprint(data.robot_text, "robot.yaml");
  EXPECT_EQ(fingerprint("# another comment\n" + data.robot_text, "elsewhere.yaml"), same);
  std::string other = data.robot_text;
  const std::size_t mass = other.find("  mass_kg: ");
  ASSERT_NE(mass, std::string::npos);
  other.insert(mass + 11, "1");
  EXPECT_NE(fingerprint(other, "robot.yaml"), same);
}

TEST(DataSet, CountsRunsAndSamplesOfEveryClass) {
  DataSet data = test::contact_examples(3, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    data.samples[i].run = i == 2 ? 5 : 4;
    data.samples[i].touched = i == 2 ? 7 : 0;
    data.samples[i].configuration = 1;
  }
  EXPECT_EQ(counts_table(data),
            "configuration        touched              runs    samples\n"
            "1                    platform                1          2\n"
            "1                    leg1_clamping           1          1\n");
}

TEST(DataSet, SaysThatItCountsMoreThanTenConfigurationsTogether) {
  DataSet data = test::contact_examples(11, 1);
  for (std::size_t i = 0; i < data.samples.size(); ++i) {
    data.samples[i].touched = 0;
    data.samples[i].configuration = static_cast<int>(i);
  }
  EXPECT_EQ(counts_table(data),
            "configuration        touched              runs    samples\n"
            "all 11 together      platform               11         11\n");
  data.samples.pop_back();
  EXPECT_THAT(counts_table(data), testing::HasSubstr("\n9                    platform                1"));
}

}  // namespace
}  // namespace flinch
