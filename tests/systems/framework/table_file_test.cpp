#include "systems/framework/table_file.h"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

class ATableFile : public ::testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const std::vector<TableColumn> columns = {{"time_s"}, {"obstacles[0].name", 13}};
  const std::vector<std::vector<TableCell>> cells = {
      {0.1, "pylon"}, {std::numeric_limits<double>::quiet_NaN(), ""}, {-3e-300, "a longer name"}};

  void write(const std::string& name, const std::map<std::string, std::string>& attributes = {}) const {
    write_table(
        columns, cells.size(), [&](std::size_t row) { return cells[row]; }, attributes, folder / name);
  }
};

TEST_F(ATableFile, HoldsEveryColumn) {
  write("table.h5", {{"format", "a table"}});
  const hid_t file = H5Fopen((folder / "table.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t numbers = H5Dopen2(file, "time_s", H5P_DEFAULT);
  std::array<double, 3> read{};
  ASSERT_GE(H5Dread(numbers, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0);
  EXPECT_EQ(read[0], 0.1);
  EXPECT_TRUE(std::isnan(read[1]));
  EXPECT_EQ(read[2], -3e-300);
  const hid_t texts = H5Dopen2(file, "obstacles[0].name", H5P_DEFAULT);
  const hid_t type = H5Dget_type(texts);
  const std::size_t width = H5Tget_size(type);
  std::string rows(3 * width, '?');
  ASSERT_GE(H5Dread(texts, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  EXPECT_STREQ(rows.substr(0, width).c_str(), "pylon");
  EXPECT_STREQ(rows.substr(width, width).c_str(), "");
  EXPECT_EQ(rows.substr(2 * width, width), "a longer name");
  H5Tclose(type);
  H5Dclose(texts);
  H5Dclose(numbers);
  H5Fclose(file);
}

TEST_F(ATableFile, IsTheSameForTheSameTable) {
  write("a.h5");
  write("b.h5");
  EXPECT_EQ(test::bytes_of(folder / "a.h5"), test::bytes_of(folder / "b.h5"));
}

TEST_F(ATableFile, HoldsMoreRowsThanAreWrittenAtOnce) {
  constexpr std::size_t many = 5000;
  const auto row = [](std::size_t k) {
    return std::vector<TableCell>{static_cast<double>(k), std::to_string(k)};
  };
  write_table({{"number"}, {"text", 4}}, many, row, {}, folder / "table.h5");
  const hid_t file = H5Fopen((folder / "table.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t numbers = H5Dopen2(file, "number", H5P_DEFAULT), texts = H5Dopen2(file, "text", H5P_DEFAULT);
  std::vector<double> read(many);
  ASSERT_GE(H5Dread(numbers, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0);
  const hid_t type = H5Dget_type(texts);
  ASSERT_EQ(H5Tget_size(type), 4U);
  std::string letters(4 * many, '?');
  ASSERT_GE(H5Dread(texts, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, letters.data()), 0);
  for (std::size_t k = 0; k < many; ++k) {
    ASSERT_EQ(read[k], static_cast<double>(k));
    ASSERT_EQ(letters.substr(4 * k, std::to_string(k).size()), std::to_string(k));
  }
  H5Tclose(type);
  H5Dclose(texts);
  H5Dclose(numbers);
  H5Fclose(file);
}

TEST_F(ATableFile, RefusesACellThatDoesNotFitItsColumn) {
  for (const std::vector<TableCell>& row :
       std::vector<std::vector<TableCell>>{{0.1, "fourteen bytes"}, {0.1, 0.2}, {"text", "text"}}) {
    EXPECT_THROW(write_table(
                     columns, 1, [&](std::size_t) { return row; }, {}, folder / "a.h5"),
                 SetupError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.h5"));
  }
}

TEST_F(ATableFile, ThatCannotBeWrittenIsToldOf) { EXPECT_THROW(write("nowhere/a.h5"), SetupError); }

}  // namespace
}  // namespace flinch
