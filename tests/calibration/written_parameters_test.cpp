#include "calibration/written_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "systems/config/parameter_file.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

ParameterFile with_value(double value, double deviation = 0.1) {
  ParameterFile file;
  file.kind = "dynamics";
  file.date = "2026-11-22";
  file.robot = {"robot.yaml", std::string(64, 'a')};
  file.parameters = {{.name = "drives.friction", .value = value, .deviation = deviation, .unit = "Nm"}};
  return file;
}

TEST(WrittenParameters, AreReadAgain) {
  const test::TemporaryFolder folder;
  for (const double value : {0.0, -3.5, 1e23, 1e-23, 1e-24, 3e-25, -2.262e-27, 1e-300}) {
    const ParameterFile file = with_value(value, std::abs(value));
    write_parameters(folder / "found.yaml", parameter_file_text(file));
    const double read = read_parameter_file(folder / "found.yaml").parameters.front().value;
    EXPECT_EQ(read, std::abs(value) < 1e-24 ? 0.0 : value);
  }
}

TEST(WrittenParameters, AreReadAgainWhateverTheFilesAreCalledThatTheyComeFrom) {
  const test::TemporaryFolder folder;
  ParameterFile file = with_value(1.0);
  const std::vector<std::string> names = {"it's: #1", "two\nlines", "a\ttab\x1b[31m",
                                          "{x}",      "\\n \"q\"",  "-"};
  for (const std::string& name : names) file.recordings.push_back({name, std::string(64, 'b')});
  write_parameters(folder / "found.yaml", parameter_file_text(file));
  const ParameterFile read = read_parameter_file(folder / "found.yaml");
  ASSERT_EQ(read.recordings.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(read.recordings[i].file, names[i]);
}

TEST(WrittenParameters, ThatNobodyCouldReadAreNotWritten) {
  const test::TemporaryFolder folder;
  const std::filesystem::path place = folder / "found.yaml";
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {infinity, -infinity, infinity - infinity, 1e25}) {
    EXPECT_THAT(test::problems_of([&] { write_parameters(place, parameter_file_text(with_value(value))); }),
                ElementsAre(AllOf(HasSubstr("is not written, for it could not be read: "),
                                  HasSubstr("found.yaml:"), HasSubstr("value: is "))))
        << value;
  }
  const std::string thresholds =
      "control:\n  contact_detector:\n    by_estimator:\n"
      "      - {estimator: momentum_observer, reaction_force_N: 2.262e-27}\n";
  EXPECT_THAT(
      test::problems_of([&] { write_parameters(place, parameter_file_text(with_value(1.0)) + thresholds); }),
      ElementsAre(HasSubstr("reaction_force_N: is 2.262e-27; it must be 0 or of a size")));
  EXPECT_FALSE(std::filesystem::exists(place));
}

}  // namespace
}  // namespace flinch
