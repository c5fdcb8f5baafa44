#include "calibration/csv_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <numbers>

#include "calibration/csv_table.h"
#include "identification/torque_constant_calibration.h"
#include "systems/framework/hdf5_object.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/joint_reading.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

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
    return test::problems_of([this] { read_csv_recording(place / "mapping.yaml"); });
  }
  test::Workplace place;
};

TEST(ALog, GivesTheTorqueConstantsOfTheRunThatItLogs) {
  const test::Simulated run = test::simulated("calibration_pulls.yaml");
  const test::Workplace place;
  write_log(run.recording, place / "log.csv");
  place.write("mapping.yaml", mapping);
  const Recording imported = read_csv_recording(place / "mapping.yaml");
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
void write_hdf5_log(const CsvTable& table, const std::filesystem::path& file) {
  internal::write_hdf5_result(file, 1U << 26U, [&](internal::Hdf5Object::Id id) {
    const auto rows = static_cast<std::size_t>(table.values.rows());
    const internal::Hdf5Object group = internal::make_group(id, "log");
    std::vector<double> time(rows);
    for (std::size_t k = 0; k < rows; ++k) time[k] = table.values(static_cast<Eigen::Index>(k), 0);
    internal::write_reals(group, "t_ms", time);
    std::vector<internal::Number> numbers;
    for (std::size_t k = 0; k < rows; ++k) {
      for (Eigen::Index column = 1; column < table.values.cols(); ++column) {
        internal::Number number{};
        number.real = table.values(static_cast<Eigen::Index>(k), column);
        numbers.push_back(number);
      }
    }
    const auto columns = static_cast<std::size_t>(table.values.cols() - 1);
    const internal::Hdf5Object set = internal::make_table(group, "values", Field::Kind::real, columns, 1000);
    internal::append_rows(set, Field::Kind::real, 0, rows, columns, numbers.data());
  });
}

TEST(ALog, OfHdf5GivesTheRecordingThatItGivesAsCsv) {
  const test::Simulated run =
      test::simulated("calibration_pulls.yaml", {{"duration_s: 46", "duration_s: 1"}});
  const test::Workplace place;
  write_log(run.recording, place / "log.csv");
  place.write("mapping.yaml", mapping);
  const Recording from_csv = read_csv_recording(place / "mapping.yaml");
  const std::vector<std::string> names = {"t_ms", "q1", "q2", "q3", "p1", "p2",
                                          "p3",   "i1", "i2", "i3", "fx", "fy"};
  write_hdf5_log(read_csv(place / "log.csv", ',', names), place / "log.h5");
  place.replace("mapping.yaml", "csv: log.csv", "hdf5: log.h5");
  place.replace("mapping.yaml", "column: t_ms", "column: /log/t_ms");
  for (std::size_t i = 1; i < names.size(); ++i) {
    place.replace("mapping.yaml", "column: " + names[i] + ",",
                  "column: \"/log/values[" + std::to_string(i - 1) + "]\",");
  }
  const Recording from_hdf5 = read_csv_recording(place / "mapping.yaml");
  ASSERT_EQ(from_hdf5.samples(), from_csv.samples());
  for (std::size_t s = 0; s < from_csv.signals.size(); ++s) {
    ASSERT_EQ(from_hdf5.signals[s].path, from_csv.signals[s].path);
    for (std::size_t k = 0; k < from_csv.signals[s].rows.size(); ++k)
      ASSERT_EQ(from_hdf5.signals[s].rows[k].integer, from_csv.signals[s].rows[k].integer);
  }
  place.replace("mapping.yaml", "values[3]", "values[30]");
  EXPECT_THAT(
      test::problems_of([&] { read_csv_recording(place / "mapping.yaml"); }),
      Contains(HasSubstr("log.h5: column '/log/values[30]' is not there; the data set has 11 columns")));
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
  EXPECT_THAT(problems(), Contains(HasSubstr("columns[0].unit: is 'N', which is no unit of this quantity")));
  EXPECT_THAT(problems(), Contains(HasSubstr("columns[0].sign")));
}

TEST_F(ImportedLog, MustHaveATimeThatGrows) {
  place.write("log.csv", "t_ms,q1\n0,1\n1,2\n1,3\n");
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/calibration_pulls.yaml\n"
              "time: {column: t_ms, unit: ms}\ncolumns:\n"
              "  - {column: q1, signal: joints.active, entry: 0, unit: deg}\n");
  EXPECT_THAT(problems(), Contains(HasSubstr("log.csv:4: column 't_ms' does not grow")));
}

TEST_F(ImportedLog, MayNotPassThroughMoreTimeThanItsRowsTellOf) {
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/calibration_pulls.yaml\n"
              "time: {column: t_ms, unit: ms}\n");
  for (const char* const last : {"1e9", "1e300"}) {
    place.write("log.csv", std::string("t_ms\n0\n1\n") + last + "\n");
    EXPECT_THAT(problems(), Contains(HasSubstr("in 3 rows; check the unit of the time, or 'period'")))
        << last;
  }
}

}  // namespace
}  // namespace flinch
