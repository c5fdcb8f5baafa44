// What is exported is what was recorded: read back by Python's own readers of zip, zlib, CSV and JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "export/byte_text.h"
#include "export/csv_folder.h"
#include "export/deflated_bytes.h"
#include "export/exported_signal.h"
#include "export/mat_file.h"
#include "export/mcap_file.h"
#include "export/npz_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using SixVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

struct Motion {
  std::int64_t count = 0;
  bool valid = false;
  SixVector drives;     ///< two
  SixVector wrench;     ///< of a planar robot
  SixVector sometimes;  ///< none, or two
  SixVector never;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double share = 0.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("count", "ns", self.count);
    visit("valid", "", self.valid);
    visit("drives", "rad", self.drives);
    visit("wrench", "N, N, Nm", self.wrench, "base");
    visit("sometimes", "rad", self.sometimes);
    visit("never", "A", self.never);
    visit("inner.force", "m/s^2", self.force, "imu");
    visit("share", "1", self.share);
  }
};

/// 5000 samples, more than a block, of numbers with all their digits, and some that are none.
Recording some_recording() {
  Recording recording;
  recording.period = 4ms;
  Signal signal{"station/motion", row_layout<Motion>(), {}};
  RandomGenerator random(7);
  for (std::int64_t k = 0; k < 5000; ++k) {
    recording.time_ns.push_back(k * 4'000'000 + k % 3);
    Motion motion;
    motion.count = k - 2500;
    motion.valid = k % 3 == 0;
    motion.drives = SixVector::Zero(2);
    motion.wrench = SixVector::Zero(3);
    for (double* const value : {&motion.drives[0], &motion.drives[1], &motion.wrench[0], &motion.wrench[1],
                                &motion.wrench[2], &motion.force[0], &motion.force[1], &motion.force[2]})
      *value = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-12.0, 12.0));
    if (k % 5 == 0) motion.sometimes = SixVector::Constant(2, 0.1 * static_cast<double>(k));
    motion.share = k == 17 ? std::numeric_limits<double>::quiet_NaN() : 1.0 / 3.0;
    std::vector<internal::Number> row(signal.layout.numbers);
    write_row(motion, row.data());
    signal.rows.insert(signal.rows.end(), row.begin(), row.end());
  }
  recording.signals.push_back(std::move(signal));
  return recording;
}

class AnExport : public ::testing::Test {
 protected:
  test::TemporaryFolder folder;
  Recording recording = some_recording();
  std::vector<ExportedSignal> signals = exported_signals(recording, {});
};

TEST_F(AnExport, IsAsWideAsItEverWasWithNamesAndUnits) {
  ASSERT_EQ(signals.size(), 1U);
  std::vector<std::string> columns, units;
  for (const ExportedField& field : signals[0].fields) {
    for (std::size_t i = 0; i < field.width(); ++i) {
      columns.push_back(field.column(i));
      units.push_back(field.units[i]);
    }
  }
  EXPECT_THAT(columns, ElementsAre("count", "valid", "drives_1", "drives_2", "wrench_fx", "wrench_fy",
                                   "wrench_mz", "sometimes_1", "sometimes_2", "inner.force_x",
                                   "inner.force_y", "inner.force_z", "share"));
  EXPECT_THAT(units, ElementsAre("ns", "", "rad", "rad", "N", "N", "Nm", "rad", "rad", "m/s^2", "m/s^2",
                                 "m/s^2", "1"));
  EXPECT_THAT(signals[0].left_out, ElementsAre("never"));
}

TEST_F(AnExport, RefusesSignalsThatAreNotThere) {
  EXPECT_THAT(test::problems_of([&] { exported_signals(recording, {"station/motions"}); }),
              ElementsAre(HasSubstr("station/motion")));
}

TEST_F(AnExport, AsTextHasTheVeryBits) {
  write_csv_folder(recording, signals, folder / "csv");
  const std::string text = test::bytes_of(folder / "csv/station.motion.csv");
  EXPECT_TRUE(text.starts_with("time_s,count [ns],valid,drives_1 [rad],drives_2 [rad],wrench_fx [N]"))
      << text.substr(0, 80);
  const std::vector<double> drive = recording.column("station/motion", "drives", 1);
  std::size_t at = text.find('\n') + 1;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    std::vector<std::string> cells(1);
    for (; text[at] != '\n'; ++at) {
      if (text[at] == ',')
        cells.emplace_back();
      else
        cells.back() += text[at];
    }
    ++at;
    ASSERT_EQ(cells.size(), 14U);
    ASSERT_EQ(std::stod(cells[4]), drive[k]) << k;
    ASSERT_EQ(cells[8].empty(), k % 5 != 0) << "no data is no zero";
    ASSERT_EQ(std::llround(1e9 * std::stod(cells[0])), recording.time_ns[k]);
  }
  EXPECT_EQ(at, text.size());
}

TEST_F(AnExport, SaysTheSameInEveryFormat) {
  write_csv_folder(recording, signals, folder / "csv");
  write_npz(recording, signals, folder / "run.npz");
  write_mat(recording, signals, folder / "run.mat");
  write_mcap(recording, signals, folder / "run.mcap");
  const std::string command =
      "python3 '" FLINCH_SOURCE_DIR "/tests/export/read_exports.py' '" + (folder / "").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(AnExport, IsReadByH5pyAndNumpy) {
  write_recording(recording, folder / "run.h5");
  write_csv_folder(recording, signals, folder / "csv");
  write_npz(recording, signals, folder / "run.npz");
  const std::string command =  // by Debian's Python, which has them
      "PATH=/usr/bin:$PATH python3 '" FLINCH_SOURCE_DIR "/tests/export/read_by_tools.py' '" +
      (folder / "").string() + "'";
  const int status = WEXITSTATUS(std::system(command.c_str()));
  if (status == 77) GTEST_SKIP() << "h5py and NumPy are not installed";
  EXPECT_EQ(status, 0);
}

TEST_F(AnExport, IsTheSameEachTime) {
  for (const char* name : {"one", "two"}) {
    write_npz(recording, signals, folder / (std::string(name) + ".npz"));
    write_mat(recording, signals, folder / (std::string(name) + ".mat"));
  }
  EXPECT_EQ(test::bytes_of(folder / "one.npz"), test::bytes_of(folder / "two.npz"));
  EXPECT_EQ(test::bytes_of(folder / "one.mat"), test::bytes_of(folder / "two.mat"));
}

TEST(DeflatedBytes, KnowTheChecksumOfWhatCameIn) {
  DeflatedBytes bytes(DeflatedBytes::Form::raw);
  bytes.add("123456789", 9);
  EXPECT_EQ(bytes.checksum(), 0xCBF43926U);  // the check value of CRC-32
  EXPECT_EQ(bytes.size_before(), 9U);
  EXPECT_FALSE(bytes.finish().empty());
}

TEST(ByteText, BeginsWithTheLowestByte) {
  std::string bytes;
  append_bytes(std::uint16_t{0x0102}, bytes);
  EXPECT_EQ(bytes, "\x02\x01");
}

}  // namespace
}  // namespace flinch
