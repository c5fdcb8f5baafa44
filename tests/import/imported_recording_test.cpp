#include "import/imported_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <iomanip>
#include <iostream>
#include <numbers>

#include "identification/torque_constant_calibration.h"
#include "systems/framework/hdf5_table.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/joint_reading.h"
#include "tests/identification/recorded.h"
#include "tests/support/hdf5_columns.h"
#include "tests/support/problems_of.h"
#include "tests/support/sanitized.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// As another tool might log a simulated run: angles in degrees, one of them the other way round, currents in
/// mA.
void write_log(const Recording& recording, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "t_ms,q1,q2,q3,p1,p2,p3,i1,i2,i3,fx,fy\n" << std::setprecision(12);
  const auto joints = read<JointReading>(recording, "joints");
  const auto drives = read<DriveReading>(recording, "drives");
  const auto pulls = read<ForceTorqueReading>(recording, "force_torque");
  constexpr double degree = std::numbers::pi / 180.0;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const JointReading at = joints[k];
    const DriveReading drive = drives[k];
    if (!at.valid || !drive.valid) continue;
    out << 5000.0 + static_cast<double>(k);
    for (int i = 0; i < 3; ++i) out << ',' << (i == 1 ? -1.0 : 1.0) * at.active[i] / degree;
    for (int i = 0; i < 3; ++i) out << ',' << at.passive[i];
    for (int i = 0; i < 3; ++i) out << ',' << 1000.0 * drive.current[i];
    const ForceTorqueReading pull = pulls[k];
    out << ',' << pull.force_in_base.x() << ',' << pull.force_in_base.y() << '\n';
  }
}

constexpr const char* mapping = R"(csv: log.csv
scenario: scenarios/calibration_pulls.yaml
time: {column: t_ms, unit: ms}
columns:
  - {column: q1, signal: joints.active, entry: 0, unit: deg}
  - {column: q2, signal: joints.active, entry: 1, unit: deg, sign: -1}
  - {column: q3, signal: joints.active, entry: 2, unit: deg}
  - {column: p1, signal: joints.passive, entry: 0, unit: rad}
  - {column: p2, signal: joints.passive, entry: 1, unit: rad}
  - {column: p3, signal: joints.passive, entry: 2, unit: rad}
  - {column: i1, signal: drives.current, entry: 0, unit: mA}
  - {column: i2, signal: drives.current, entry: 1, unit: mA}
  - {column: i3, signal: drives.current, entry: 2, unit: mA}
  - {column: fx, signal: force_torque.force, entry: 0, unit: N}
  - {column: fy, signal: force_torque.force, entry: 1, unit: N}
)";

class ImportedLog : public ::testing::Test {
 protected:
  std::vector<std::string> problems() const {
    return test::problems_of([this] { import_log(place / "mapping.yaml"); });
  }
  test::Workplace place;
};

TEST(ALog, GivesTheTorqueConstantsOfTheRunThatItLogs) {
  const test::Simulated run = test::simulated("calibration_pulls.yaml");
  const test::Workplace place;
  write_log(run.recording, place / "log.csv");
  place.write("mapping.yaml", mapping);
  const Recording imported = import_log(place / "mapping.yaml");
  const TorqueConstantBelief belief{.robot = run.scenario.robot.robot.get(),
                                    .drives = run.scenario.robot.drives,
                                    .constant = run.scenario.control.drive_torque.torque_constant};
  const auto calibrated = [&](const Recording& recording) {
    return calibrate_torque_constants(belief, {{{"run.h5", ""}, &recording, run.scenario.mountings}}, {});
  };
  const CalibrationResult direct = calibrated(run.recording);
  const CalibrationResult got = calibrated(imported);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(got.parameters[i].value, direct.parameters[i].value, *direct.parameters[i].deviation);
}

/// The same log as data sets: one of two dimensions for each group of columns, currents as whole mA.
void write_hdf5_log(const std::vector<std::vector<double>>& columns_of_log,
                    const std::filesystem::path& file) {
  internal::write_hdf5_result(file, 1U << 26U, [&](internal::Hdf5Object::Id id) {
    const std::size_t rows = columns_of_log.front().size();
    const internal::Hdf5Object group = internal::make_group(id, "log");
    test::write_reals(group, "t_ms", columns_of_log.front());
    std::vector<internal::Number> numbers;
    for (std::size_t k = 0; k < rows; ++k) {
      for (std::size_t column = 1; column < columns_of_log.size(); ++column) {
        internal::Number number{};
        number.real = columns_of_log[column][k];
        numbers.push_back(number);
      }
    }
    const auto columns = columns_of_log.size() - 1;
    const internal::Hdf5Object set = internal::make_table(group, "values", Field::Kind::real, columns, 1000);
    internal::append_rows(set, Field::Kind::real, 0, rows, columns, numbers.data());
  });
}

/// All numbers of a signal, as integers of the same bits.
std::vector<std::int64_t> numbers_of(const Recording& recording, std::size_t signal) {
  const Signal& of = recording.signals[signal];
  std::vector<internal::Number> rows(recording.samples() * of.layout.numbers);
  recording.read_rows(of, 0, recording.samples(), rows.data());
  std::vector<std::int64_t> bits;
  for (const internal::Number& number : rows) bits.push_back(number.integer);
  return bits;
}

TEST(ALog, OfHdf5GivesTheRecordingThatItGivesAsCsv) {
  const test::Simulated run =
      test::simulated("calibration_pulls.yaml", {{"duration_s: 46", "duration_s: 1"}});
  const test::Workplace place;
  write_log(run.recording, place / "log.csv");
  place.write("mapping.yaml", mapping);
  const Recording from_csv = import_log(place / "mapping.yaml");
  const std::vector<std::string> names = {"t_ms", "q1", "q2", "q3", "p1", "p2",
                                          "p3",   "i1", "i2", "i3", "fx", "fy"};
  const std::unique_ptr<LogFile> log = open_log(place / "log.csv");
  std::vector<std::size_t> all(names.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = log->find(names[i]);
  write_hdf5_log(log->read(all), place / "log.h5");
  place.replace("mapping.yaml", "csv: log.csv", "hdf5: log.h5");
  place.replace("mapping.yaml", "column: t_ms", "column: /log/t_ms");
  for (std::size_t i = 1; i < names.size(); ++i) {
    place.replace("mapping.yaml", "column: " + names[i] + ",",
                  "column: \"/log/values[" + std::to_string(i - 1) + "]\",");
  }
  const Recording from_hdf5 = import_log(place / "mapping.yaml");
  ASSERT_EQ(from_hdf5.samples(), from_csv.samples());
  for (std::size_t s = 0; s < from_csv.signals.size(); ++s) {
    ASSERT_EQ(from_hdf5.signals[s].path, from_csv.signals[s].path);
    const std::vector<std::int64_t> other = numbers_of(from_hdf5, s), one = numbers_of(from_csv, s);
    ASSERT_EQ(other, one);
  }
  place.replace("mapping.yaml", "values[3]", "values[30]");
  EXPECT_THAT(test::problems_of([&] { import_log(place / "mapping.yaml"); }),
              Contains(HasSubstr("log.h5: there is no column '/log/values[30]'")));
}

/// Forces in the axes of a body need the samples before.
TEST(ALog, IsReadAlikeWhereverOneBegins) {
  const test::Simulated run =
      test::simulated("calibration_pulls.yaml", {{"duration_s: 46", "duration_s: 9"}});
  const test::Workplace place;
  write_log(run.recording, place / "log.csv");
  place.write("mapping.yaml", mapping);
  for (const char* const force :
       {"fx, signal: force_torque.force, entry: 0", "fy, signal: force_torque.force, entry: 1"})
    place.replace("mapping.yaml", force, force + std::string(", frame: body"));
  const Recording imported = import_log(place / "mapping.yaml");
  const auto in_order = read<ForceTorqueReading>(imported, "force_torque");
  const auto forces = read<ForceTorqueReading>(run.recording, "force_torque");
  ASSERT_GT(imported.samples(), 2 * Recording::block);
  double largest_turn = 0.0;
  for (std::size_t k = 0; k < imported.samples(); ++k)
    largest_turn = std::max(largest_turn, (in_order[k].force_in_base - forces[k].force_in_base).norm());
  EXPECT_GT(largest_turn, 0.1);  // the body is turned, so its axes are not those of the base
  const Signal& signal = imported.signal("force_torque");
  std::vector<internal::Number> row(signal.layout.numbers);
  const std::vector<std::int64_t> all =
      numbers_of(imported, static_cast<std::size_t>(&signal - imported.signals.data()));
  for (const std::size_t k :
       {imported.samples() - 1, Recording::block, Recording::block - 1, std::size_t{7}}) {
    imported.read_rows(signal, k, 1, row.data());
    for (std::size_t i = 0; i < row.size(); ++i) EXPECT_EQ(row[i].integer, all[k * row.size() + i]) << k;
  }
}

/// So much that rows of a recording would not fit into it: 1.2 million of 20 bytes.
TEST_F(ImportedLog, TakesFourTimesItsSizeInMemoryAtMost) {
#ifdef FLINCH_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps memory for itself";
#endif
  {
    std::ofstream log(place / "log.csv");
    log << "t_ms,q1,q2,q3\n";
    for (int k = 0; k < 1'200'000; ++k) log << k << ",1.25,-3,0.5\n";
  }
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/calibration_pulls.yaml\n"
              "time: {column: t_ms, unit: ms}\ncolumns:\n"
              "  - {column: q1, signal: joints.active, entry: 0, unit: deg}\n"
              "  - {column: q2, signal: joints.active, entry: 1, unit: deg}\n"
              "  - {column: q3, signal: joints.active, entry: 2, unit: deg}\n");
  const auto peak_kB = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const long before = peak_kB();
  const Recording imported = import_log(place / "mapping.yaml");
  const auto joints = read<JointReading>(imported, "joints");
  double sum = 0.0;
  for (std::size_t k = 0; k < imported.samples(); ++k) sum += joints[k].active.sum();
  EXPECT_NEAR(sum / 1.2e6, -1.25 * std::numbers::pi / 180.0, 1e-9);
  const long size_kB = static_cast<long>(std::filesystem::file_size(place / "log.csv")) / 1024;
  std::cout << "a log of " << size_kB << " kB took " << peak_kB() - before << " kB" << std::endl;
  EXPECT_LT(peak_kB() - before, 4 * size_kB);
}

TEST_F(ImportedLog, MustHaveAllJointsAndKnownSignals) {
  place.write("log.csv", "t_ms,q1\n0,1\n1,2\n");
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/calibration_pulls.yaml\n"
              "time: {column: t_ms, unit: ms}\ncolumns:\n"
              "  - {column: q1, signal: joints.active, entry: 0, unit: deg}\n");
  EXPECT_THAT(problems(), Contains(HasSubstr("no column is mapped to entry 1 of joints.active")));
  place.replace("mapping.yaml", "joints.active", "joint.active");
  EXPECT_THAT(problems(), Contains(HasSubstr("did you mean 'joints.active'?")));
  place.replace("mapping.yaml", "joint.active, entry: 0, unit: deg",
                "joints.active, entry: 7, unit: N, sign: 2");
  EXPECT_THAT(
      problems(),
      Contains(HasSubstr("columns[0].unit: is 'N', which is no unit of this quantity; known are: rad,")));
  EXPECT_THAT(problems(), Contains(HasSubstr("columns[0].sign")));
}

TEST_F(ImportedLog, MustHaveATimeThatGrows) {
  place.write("log.csv", "t_ms,q1\n1,1\n1,2\n1,3\n");
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/calibration_pulls.yaml\n"
              "time: {column: t_ms, unit: ms}\ncolumns:\n"
              "  - {column: q1, signal: joints.active, entry: 0, unit: deg}\n");
  EXPECT_THAT(problems(), Contains(HasSubstr("log.csv: column 't_ms' does not grow")));
  place.write("log.csv", "t_ms,q1\n1732012416,1\n1732012416,2\n1732012416,3\n");
  EXPECT_THAT(problems(),
              Contains(HasSubstr("single precision, which tells times so large apart by 128 only")));
  place.write("log.csv", "t_ms,q1\n1e30,1\n2e30,2\n3e30,3\n");
  EXPECT_THAT(problems(), Contains(HasSubstr("too large for its unit: check 'unit' of 'time'")));
}

TEST_F(ImportedLog, MayNotPassThroughMoreTimeThanItsRowsTellOf) {
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/calibration_pulls.yaml\n"
              "period_ms: 1\ntime: {column: t_ms, unit: ms}\ncolumns:\n"
              "  - {column: q1, signal: joints.active, entry: 0, unit: deg}\n");
  for (const char* const last : {"1e9", "1e12"}) {
    place.write("log.csv", std::string("t_ms,q1\n0,1\n1,2\n") + last + ",3\n");
    EXPECT_THAT(problems(), Contains(HasSubstr("in 3 rows; check the unit of the time, or 'period'")))
        << last;
  }
}

}  // namespace
}  // namespace flinch
